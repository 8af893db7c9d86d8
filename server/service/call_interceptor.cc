// SPDX-License-Identifier: Apache-2.0
#include "server/service/call_interceptor.h"

#include <chrono>

namespace flatlight {
namespace {

using grpc::experimental::InterceptionHookPoints;
using grpc::experimental::InterceptorBatchMethods;

class CallInterceptor final : public grpc::experimental::Interceptor {
 public:
  CallInterceptor(CallTelemetry& telemetry, grpc::experimental::ServerRpcInfo& info,
                  const CallTelemetry::Method* method)
      : telemetry_(telemetry), info_(info), start_(std::chrono::steady_clock::now()) {
    call_.method = method;
  }

  void Intercept(InterceptorBatchMethods* methods) override {
    if (methods->QueryInterceptionHookPoint(InterceptionHookPoints::POST_RECV_INITIAL_METADATA)) {
      const auto* metadata = methods->GetRecvInitialMetadata();
      if (metadata != nullptr) call_.request_id = CallTelemetry::GivenRequestId(*metadata);
    }
    const bool ends = methods->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_STATUS);
    if (ends) call_.status = methods->GetSendStatus();
    if (methods->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_INITIAL_METADATA)) {
      NameCall(ends);
      auto* metadata = methods->GetSendInitialMetadata();
      if (metadata != nullptr && !call_.request_id.empty()) {
        metadata->emplace(CallTelemetry::kRequestId, call_.request_id);
      }
    }
    if (methods->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_MESSAGE)) {
      if (auto* bytes = methods->GetSerializedSendMessage(); bytes != nullptr) {
        call_.sent_bytes += bytes->Length();
      }
    }
    if (ends) End();
    methods->Proceed();
  }

 private:
  void NameCall(bool ends) {
    if (!call_.request_id.empty() || !telemetry_.MayLog(call_.method, ends ? &call_.status : nullptr)) return;
    call_.request_id = telemetry_.NextRequestId();
  }

  void End() {
    call_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    NameCall(true);
    telemetry_.Ended(*info_.server_context(), call_, telemetry_.TakeNotes(*info_.server_context()));
  }

  CallTelemetry& telemetry_;
  grpc::experimental::ServerRpcInfo& info_;
  const std::chrono::steady_clock::time_point start_;
  CallTelemetry::Call call_;
};

}  // namespace

grpc::experimental::Interceptor* CallInterceptors::CreateServerInterceptor(grpc::experimental::ServerRpcInfo* info) {
  const CallTelemetry::Method* const method = telemetry_.Find(info->method());
  if (method != nullptr && method->is_unary) return nullptr;
  return new CallInterceptor(telemetry_, *info, method);
}

}  // namespace flatlight
