// SPDX-License-Identifier: Apache-2.0
#include "server/service/unary_answer.h"

#include "server/service/status_convert.h"

namespace flatlight {

void UnaryAnswer::Finish(const grpc::Status& status, const Notes& notes, std::uint64_t sent_bytes) const {
  CallTelemetry::Call call;
  call.method = &method_;
  call.request_id = CallTelemetry::GivenRequestId(context_.client_metadata());
  if (call.request_id.empty() && MayLog(status)) call.request_id = telemetry_.NextRequestId();
  if (!call.request_id.empty()) context_.AddInitialMetadata(CallTelemetry::kRequestId, call.request_id);
  call.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  call.sent_bytes = sent_bytes;
  call.status = status;
  telemetry_.Ended(context_, call, notes);
  reactor_->Finish(status);
}

void UnaryAnswer::Refuse(const absl::Status& status, const Notes& notes) const {
  Finish(ToGrpcStatus(status), notes, 0);
}

}  // namespace flatlight
