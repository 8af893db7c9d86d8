// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_STREAM_CALLER_H_
#define FLATLIGHT_SERVER_SERVICE_STREAM_CALLER_H_

#include <string_view>

#include "absl/status/statusor.h"
#include "grpcpp/server_context.h"
#include "server/service/backend.h"

namespace flatlight {

// Who asks for a stream, and may: the guard's Identify and Admit. Whom it identifies is noted for the logs, admitted or
// not.
absl::StatusOr<Caller> AdmitStream(Backend& backend, const grpc::ServerContextBase& context, std::string_view request);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_STREAM_CALLER_H_
