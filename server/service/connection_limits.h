// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_CONNECTION_LIMITS_H_
#define FLATLIGHT_SERVER_SERVICE_CONNECTION_LIMITS_H_

#include <chrono>

#include "grpcpp/server_builder.h"
#include "server/service/limits.h"

namespace flatlight {

// What connections may cost, before any call is looked at: bytes of messages and of their metadata, streams of one
// connection, memory of them all. A caller whose calls have been quiet for `keepalive` is asked whether it is there;
// one that does not answer for five times as long has gone, and with it its calls (also where its machine vanished
// without a word).
void SetConnectionLimits(grpc::ServerBuilder& builder, const Limits& limits, std::chrono::milliseconds keepalive);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_CONNECTION_LIMITS_H_
