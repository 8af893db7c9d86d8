// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_CONNECTION_HEALTH_H_
#define FLATLIGHT_CLIENT_CLI_CONNECTION_HEALTH_H_

#include "absl/status/status.h"
#include "client/cli/connection/interruption.h"
#include "client/cli/connection/server_address.h"
#include "client/cli/tls/tls.h"

namespace flatlight {

// OK if the server says that it serves (grpc.health.v1, which asks for no token). UNAVAILABLE if it says something
// else, cannot be reached, or does not answer within 3 s. INTERRUPTED after a signal.
absl::Status CheckHealth(const ServerAddress& address, const Tls& tls, Interruption& interruption);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_CONNECTION_HEALTH_H_
