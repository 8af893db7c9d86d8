// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_CALL_TELEMETRY_H_
#define FLATLIGHT_SERVER_SERVICE_CALL_TELEMETRY_H_

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "grpcpp/server_context.h"
#include "grpcpp/support/server_interceptor.h"
#include "server/telemetry/json_log.h"
#include "server/telemetry/metrics.h"

namespace flatlight {

// Sees every call from its arrival to its answer: counts it, gives it an id (the caller's "x-request-id", or one of its
// own), sends that back under the same name, and writes it to the logs. The call log has each call of a flatlight
// service; the audit log those that change something, and those that were not allowed. A call that has no line in
// either is given no id.
class CallTelemetry {
 public:
  // The logs may be null. What is passed in must outlive the calls.
  CallTelemetry(Metrics& metrics, JsonLog* calls, JsonLog* audit, const std::vector<std::string>& services);

  // Of a method or its request ("GetJobRequest"): Get, List, Watch, Explain, Validate change nothing.
  static bool OnlyLooks(std::string_view name);
  // Whether such a call is logged whatever its answer; else it is if it is denied. What is noted of others costs time
  // for nothing.
  bool LogsAll(bool only_looks) const { return calls_ != nullptr || (audit_ != nullptr && !only_looks); }
  // Who calls, and which job or scene it is about. While the call has no answer.
  void NoteCaller(const grpc::ServerContextBase& context, const std::string& caller);
  // Of a call that changes with whom something is shared.
  void NoteGrantee(const grpc::ServerContextBase& context, const std::string& grantee);
  void NoteResource(const grpc::ServerContextBase& context, const std::string& name);

  // For the server's builder; outlived by this.
  std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> MakeFactory();

  // What there is to know of a method before it is called.
  struct Method {
    std::string name;  // "RenderService/CreateJob".
    Metrics::Method* metrics = nullptr;
    bool only_looks = false;
  };
  // By "/flatlight.v1.RenderService/CreateJob"; null: of no flatlight service.
  const Method* Find(std::string_view path) const;
  // Whether the logs get a line of a call. `status`: how it ends; null: that is not known yet.
  bool MayLog(const Method* method, const grpc::Status* status) const;

  struct Call {
    const Method* method = nullptr;
    std::string request_id;
    double seconds = 0;
    std::uint64_t sent_bytes = 0;
    grpc::Status status;
  };
  std::string NextRequestId();
  const Metrics& metrics() const { return metrics_; }
  double uptime_seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  bool logs() const { return calls_ != nullptr || audit_ != nullptr; }
  static bool IsDenied(const grpc::Status& status) {
    return status.error_code() == grpc::StatusCode::UNAUTHENTICATED ||
           status.error_code() == grpc::StatusCode::PERMISSION_DENIED;
  }
  void Ended(const grpc::ServerContextBase* context, const Call& call);

 private:
  struct Notes {
    std::string caller;
    std::string resource;
    std::string grantee;
  };
  struct Shard {
    std::mutex mutex;
    std::unordered_map<const grpc::ServerContextBase*, Notes> notes ABSL_GUARDED_BY(mutex);
  };

  Shard& ShardOf(const grpc::ServerContextBase* context);

  Metrics& metrics_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  JsonLog* const calls_;
  JsonLog* const audit_;
  struct Hash {
    using is_transparent = void;
    std::size_t operator()(std::string_view text) const { return std::hash<std::string_view>()(text); }
  };
  std::unordered_map<std::string, Method, Hash, std::equal_to<>> methods_;  // Of the services, by their path.
  Metrics::Method& other_methods_;
  const std::string id_prefix_;
  std::atomic<std::uint64_t> next_id_ = 0;
  std::array<Shard, 16> shards_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_CALL_TELEMETRY_H_
