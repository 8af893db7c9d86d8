// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_CONNECTION_LIMITS_H_
#define FLATLIGHT_SERVER_SERVICE_CONNECTION_LIMITS_H_

#include <chrono>
#include <cstddef>

#include "grpcpp/server_builder.h"
#include "server/service/limits.h"

namespace flatlight {

// What connections may cost, before any call is looked at: bytes of messages and of their metadata, streams of one
// connection, and `memory_bytes` for what gRPC holds of all: where that is taken, further calls are refused, and
// connections that lie idle are closed. A caller whose calls have been quiet for `keepalive` is asked whether it is
// there; one that does not answer for five times as long has gone, and with it its calls (also where its machine
// vanished without a word).
void SetConnectionLimits(grpc::ServerBuilder& builder, const Limits& limits, std::chrono::milliseconds keepalive,
                         std::size_t memory_bytes);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_CONNECTION_LIMITS_H_
