// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_UNARY_ANSWER_H_
#define FLATLIGHT_SERVER_SERVICE_UNARY_ANSWER_H_

#include <chrono>
#include <cstdint>

#include "absl/status/status.h"
#include "google/protobuf/descriptor.h"
#include "grpcpp/server_context.h"
#include "grpcpp/support/server_callback.h"
#include "server/service/call_telemetry.h"

namespace flatlight {

// The answer of a unary call: the one way to finish it, so that each is counted and logged. To be made when the call
// arrives; all copies are of one call.
class UnaryAnswer {
 public:
  using Notes = CallTelemetry::Notes;

  // `request`: of the call's message. What is passed in outlives the answer.
  UnaryAnswer(CallTelemetry& telemetry, grpc::CallbackServerContext& context,
              const google::protobuf::Descriptor* request)
      : telemetry_(telemetry),
        context_(context),
        method_(telemetry.MethodOf(request)),
        reactor_(context.DefaultReactor()) {}

  // Whether what is noted of a call with that answer is logged.
  bool MayLog(const grpc::Status& status) const { return telemetry_.MayLog(&method_, &status); }
  // Once. `sent_bytes`: of the message that a good status comes with.
  void Finish(const grpc::Status& status, const Notes& notes, std::uint64_t sent_bytes) const;
  void Refuse(const absl::Status& status, const Notes& notes) const;

  grpc::ServerUnaryReactor* reactor() const { return reactor_; }

 private:
  CallTelemetry& telemetry_;
  grpc::CallbackServerContext& context_;
  const CallTelemetry::Method& method_;
  grpc::ServerUnaryReactor* reactor_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_UNARY_ANSWER_H_
