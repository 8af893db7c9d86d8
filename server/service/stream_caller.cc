// SPDX-License-Identifier: Apache-2.0
#include "server/service/stream_caller.h"

namespace flatlight {

absl::StatusOr<Caller> AdmitStream(Backend& backend, const grpc::ServerContextBase& context, std::string_view request) {
  auto caller = backend.guard.Identify(context);
  if (!caller.ok()) return caller;
  backend.telemetry.NoteCaller(context, caller->name);
  if (absl::Status admitted = backend.guard.Admit(*caller, request); !admitted.ok()) return admitted;
  return caller;
}

}  // namespace flatlight
