// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_CONNECTION_CHANNEL_H_
#define FLATLIGHT_CLIENT_CLI_CONNECTION_CHANNEL_H_

#include <grpcpp/channel.h>

#include <memory>
#include <string>

#include "absl/status/status.h"
#include "client/cli/connection/server_address.h"
#include "client/cli/tls/tls.h"

namespace flatlight {

// A channel to a server. It connects with its first call, and again whenever the connection is lost; also when the
// other side has vanished without a word, which it finds out within 20 s.
std::shared_ptr<grpc::Channel> NewChannel(const ServerAddress& address, const Tls& tls);

// What the user is told where a call did not reach the server: gRPC's message, and what it may mean. UNAVAILABLE.
absl::Status CannotReach(const ServerAddress& address, const Tls& tls, const std::string& message);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_CONNECTION_CHANNEL_H_
