// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_CALL_TELEMETRY_H_
#define FLATLIGHT_SERVER_SERVICE_CALL_TELEMETRY_H_

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "google/protobuf/descriptor.h"
#include "grpcpp/server_context.h"
#include "server/telemetry/json_log.h"
#include "server/telemetry/metrics.h"

namespace flatlight {

// Counts every call when it ends, gives it an id (the caller's "x-request-id", or one of its own), which is sent back
// under the same name, and writes it to the logs. The call log has each call of a flatlight service; the audit log
// those that change something, and those that were not allowed. A call that has no line in either is given no id.
//
// Unary calls of flatlight services tell of themselves (Answer), all others are seen by CallInterceptors: what gRPC
// does for interceptors costs more than all that is done here.
class CallTelemetry {
 public:
  using Metadata = std::multimap<grpc::string_ref, grpc::string_ref>;
  static constexpr char kRequestId[] = "x-request-id";

  // The logs may be null. What is passed in must outlive the calls.
  CallTelemetry(Metrics& metrics, JsonLog* calls, JsonLog* audit, const std::vector<std::string>& services);

  // What there is to know of a method before it is called.
  struct Method {
    std::string name;  // "RenderService/CreateJob".
    Metrics::Method* metrics = nullptr;
    bool only_looks = false;  // Get, List, Watch, Explain, Validate change nothing.
    bool is_unary = false;
  };
  // By "/flatlight.v1.RenderService/CreateJob"; null: of no flatlight service.
  const Method* Find(std::string_view path) const;
  // By its request, of a flatlight service. (Each has one of its own: PolicyRow.)
  const Method& MethodOf(const google::protobuf::Descriptor* request) const { return *by_request_.at(request); }
  // Whether the logs get a line of a call, and so what is noted of it. `status`: how it ends; null: that is not known.
  bool MayLog(const Method* method, const grpc::Status* status) const;
  // That the caller gave; empty: none that can be taken.
  static std::string GivenRequestId(const Metadata& metadata);
  std::string NextRequestId();

  struct Call {
    const Method* method = nullptr;  // Null: of no flatlight service.
    std::string request_id;
    double seconds = 0;
    std::uint64_t sent_bytes = 0;
    grpc::Status status;
  };
  // Who called, about which job or scene, and with whom it shares that, or no longer does.
  struct Notes {
    std::string caller = {};
    std::string resource = {};
    std::string grantee = {};
  };
  // Before the answer is given away: after it the context may be gone.
  void Ended(const grpc::ServerContextBase& context, const Call& call, const Notes& notes);

  // Of a stream, until TakeNotes: others than who answers it tell of its end.
  void NoteCaller(const grpc::ServerContextBase& context, const std::string& caller);
  void NoteResource(const grpc::ServerContextBase& context, const std::string& name);
  Notes TakeNotes(const grpc::ServerContextBase& context);

  const Metrics& metrics() const { return metrics_; }
  double uptime_seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  struct Shard {
    std::mutex mutex;
    std::unordered_map<const grpc::ServerContextBase*, Notes> notes ABSL_GUARDED_BY(mutex);
  };

  bool logs() const { return calls_ != nullptr || audit_ != nullptr; }
  Shard& ShardOf(const grpc::ServerContextBase& context);

  Metrics& metrics_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  JsonLog* const calls_;
  JsonLog* const audit_;
  struct Hash {
    using is_transparent = void;
    std::size_t operator()(std::string_view text) const { return std::hash<std::string_view>()(text); }
  };
  std::unordered_map<std::string, Method, Hash, std::equal_to<>> methods_;  // Of the services, by their path.
  std::unordered_map<const google::protobuf::Descriptor*, const Method*> by_request_;
  Metrics::Method& other_methods_;
  const std::string id_prefix_;
  std::atomic<std::uint64_t> next_id_ = 0;
  std::array<Shard, 16> shards_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_CALL_TELEMETRY_H_
