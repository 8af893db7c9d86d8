// SPDX-License-Identifier: Apache-2.0
// What all unary calls have in common: the guard, the parsing, the thread, the answer. Calls are taken as raw bytes
// because gRPC's own parser answers rubbish with UNIMPLEMENTED.
#ifndef FLATLIGHT_SERVER_SERVICE_CALL_H_
#define FLATLIGHT_SERVER_SERVICE_CALL_H_

#include <concepts>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "absl/status/statusor.h"
#include "flatlight/v1/server_service.pb.h"
#include "flatlight/v1/sharing.pb.h"
#include "grpcpp/server_context.h"
#include "grpcpp/support/server_callback.h"
#include "server/service/backend.h"
#include "server/service/message_bytes.h"
#include "server/service/scene_source.h"
#include "server/service/status_convert.h"
#include "server/service/unary_answer.h"
#include "server/store/error.h"
#include "server/store/grants.h"

namespace flatlight {

enum class Lane : std::uint8_t { kInline, kQuick, kSlow };

// Larger requests are parsed and handled in the slow lane.
inline constexpr std::size_t kMaxQuickBytes = 256u << 10;

// Finishes with RESOURCE_EXHAUSTED if too much waits in the lane already.
template <class Task>
absl::Status PostTo(TaskQueue& queue, std::size_t bytes, Task task) {
  if (queue.Post(bytes, std::move(task))) return absl::OkStatus();
  return MakeQuotaError("SERVER_BUSY", "max_waiting_bytes", "too many requests wait already",
                        std::chrono::milliseconds(500));
}

// Work on a call is wanted until the caller goes or the server goes down.
inline Proceed WhileWanted(const Backend& backend, const grpc::CallbackServerContext& context) {
  return [&backend, &context]() -> absl::Status {
    if (backend.draining) return MakeError(absl::StatusCode::kUnavailable, "DRAINING", "the server is going down");
    if (context.IsCancelled()) return MakeError(absl::StatusCode::kCancelled, "CALL_CANCELLED", "the caller has gone");
    return absl::OkStatus();
  };
}

// The job, scene or whatever else an answered call is about; empty if there is none, or not yet (an upload under way).
template <class Request, class Response>
std::string ResourceOf(const Request& request, const absl::StatusOr<Response>& response) {
  if constexpr (requires {
                  request.total_bytes();
                  response->received_bytes();
                }) {
    return response.ok() && response->received_bytes() == request.total_bytes() ? response->name() : "";
  } else if constexpr (std::is_same_v<Request, v1::RotateWebhookSecretRequest>) {
    return response.ok() ? "webhook-secret" : "";
  } else if constexpr (requires {
                         { request.name() } -> std::convertible_to<std::string>;
                       }) {
    return request.name();
  } else if constexpr (requires {
                         { response->name() } -> std::convertible_to<std::string>;
                       }) {
    return response.ok() ? response->name() : "";
  } else {
    return "";
  }
}

// With whom a call shares something, or no longer shares it; empty: it does neither.
template <class Request>
std::string GranteeOf(const Request& request) {
  // What is no grantee may have any length.
  if constexpr (requires { request.share().grantee(); }) {
    if (!Grantee::Parse(request.share().grantee())) return "";
    return request.share().grantee() + (request.share().access() == v1::Share::CONTROL ? " control" : " read");
  } else if constexpr (requires { request.grantee(); }) {
    return Grantee::Parse(request.grantee()) ? request.grantee() : "";
  } else {
    return "";
  }
}

// A copy of the bytes shares them.
inline grpc::ByteBuffer ToAnswer(const grpc::ByteBuffer& bytes) { return bytes; }
inline grpc::ByteBuffer ToAnswer(const google::protobuf::MessageLite& message) { return ToBytes(message); }

// A unary call whose caller is known, with all that its answer takes.
template <class Request, class Work>
struct KnownCall {
  UnaryAnswer answer;
  grpc::ByteBuffer* bytes;  // Of the answer.
  Caller caller;
  Work work;
  CallsUnderWay::Ticket ticket;

  void Refuse(const absl::Status& why) const { answer.Refuse(why, {.caller = caller.name}); }
  void Finish(const Request& request) const {
    const auto response = work(caller, request);
    std::size_t size = 0;
    if (response.ok()) {
      *bytes = ToAnswer(*response);
      size = bytes->Length();
    }
    const grpc::Status status = ToGrpcStatus(response.status());
    answer.Finish(status, answer.MayLog(status) ? NotesOf(request, response) : UnaryAnswer::Notes(), size);
  }

 private:
  template <class Response>
  UnaryAnswer::Notes NotesOf(const Request& request, const Response& response) const {
    return {.caller = caller.name, .resource = ResourceOf(request, response), .grantee = GranteeOf(request)};
  }
};

// Answers a unary call with `work(caller, request)`, a StatusOr of a message or of a serialised one, run in
// `lane(caller, request)`, or `lane(request)` where the caller does not matter.
template <class Request, class LaneOf, class Work>
grpc::ServerUnaryReactor* Answer(Backend& backend, grpc::CallbackServerContext* context, const grpc::ByteBuffer* bytes,
                                 grpc::ByteBuffer* answer_bytes, LaneOf lane, Work work) {
  const UnaryAnswer answer(backend.telemetry, *context, Request::descriptor());
  grpc::ServerUnaryReactor* const reactor = answer.reactor();
  absl::StatusOr<Caller> caller = backend.guard.Identify(*context);
  if (!caller.ok()) {
    answer.Refuse(caller.status(), {});
    return reactor;
  }
  KnownCall<Request, Work> call{answer, answer_bytes, *std::move(caller), std::move(work), backend.calls.Enter()};
  if (absl::Status admitted = backend.guard.Admit(call.caller, Request::descriptor()->name()); !admitted.ok()) {
    call.Refuse(admitted);
    return reactor;
  }
  const std::size_t size = bytes->Length();
  if (size > kMaxQuickBytes) {
    const absl::Status posted = PostTo(backend.slow, size, [call, bytes] {
      Request request;
      if (absl::Status parsed = FromBytes(*bytes, request); !parsed.ok()) return call.Refuse(parsed);
      call.Finish(request);
    });
    if (!posted.ok()) call.Refuse(posted);
    return reactor;
  }
  Request request;
  if (absl::Status parsed = FromBytes(*bytes, request); !parsed.ok()) {
    call.Refuse(parsed);
    return reactor;
  }
  Lane where;
  if constexpr (std::invocable<LaneOf, const Caller&, const Request&>) {
    where = lane(call.caller, request);
  } else {
    where = lane(request);
  }
  if (where == Lane::kInline) {
    call.Finish(request);
    return reactor;
  }
  const absl::Status posted =
      PostTo(where == Lane::kQuick ? backend.quick : backend.slow, size,
             [call, request = std::make_shared<Request>(std::move(request))] { call.Finish(*request); });
  if (!posted.ok()) call.Refuse(posted);
  return reactor;
}

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_CALL_H_
