// SPDX-License-Identifier: Apache-2.0
#include "server/service/capabilities.h"

#include <cstddef>

#include "core/render/plan.h"
#include "flatlight/v1/server_service.pb.h"
#include "google/protobuf/arena.h"
#include "server/convert/scene_reader.h"
#include "server/service/job_convert.h"
#include "server/service/machine.h"
#include "server/service/message_bytes.h"
#include "server/service/quota_calls.h"

namespace flatlight {
namespace {

constexpr std::size_t kOwnBytes = 2048;  // More than a caller's quotas take; what is over comes from the heap.

v1::Limits LimitsToProto(const Limits& limits, const Quotas& quotas) {
  v1::Limits out;
  out.set_max_message_bytes(limits.max_message_bytes);
  out.set_max_scene_bytes(limits.max_scene_bytes);
  out.set_max_scene_depth(kMaxSceneDepth);
  out.set_max_curves(limits.max_curves);
  out.set_max_probe_points(limits.max_probe_points);
  out.set_max_pixels(limits.max_pixels);
  out.set_max_running_jobs(limits.max_running_jobs);
  out.set_max_jobs(limits.max_jobs);
  out.set_max_jobs_per_user(quotas.jobs.value_or(limits.max_jobs));
  out.set_max_watches(limits.max_watches);
  return out;
}

// All but the caller's quotas.
v1::GetCapabilitiesResponse FixedPart(const Backend& backend, Role role) {
  v1::GetCapabilitiesResponse response;
  response.set_version(backend.version);
  response.set_api_version("flatlight.v1");
  for (const std::string& method : MethodNames()) response.add_methods(method);
  for (const std::string& skip : SkipNames()) response.add_skips(skip);
  *response.mutable_limits() = LimitsToProto(backend.limits, backend.guard.QuotasOf(role));
  response.set_threads(static_cast<std::uint32_t>(backend.threads));
  response.set_processor(ProcessorModel());
  response.set_processors(backend.processors);
  for (std::size_t i = 0; i < kJobClasses; ++i) {
    v1::Retention& retention = *response.add_retention();
    const auto job_class = static_cast<JobClass>(i);
    retention.set_job_class(JobClassToProto(job_class));
    if (const auto kept = backend.retention.Of(job_class))
      retention.set_keep_seconds(static_cast<double>(kept->count()));
  }
  for (const std::string& host : backend.webhook_rules.hosts()) response.add_webhook_hosts(host);
  return response;
}

}  // namespace

Capabilities::Capabilities(Backend& backend) : backend_(backend) {
  for (std::size_t i = 0; i < fixed_.size(); ++i) {
    fixed_[i] = FixedPart(backend, static_cast<Role>(i)).SerializeAsString();
  }
}

grpc::ByteBuffer Capabilities::For(const Caller& caller) const {
  alignas(std::max_align_t) std::array<char, kOwnBytes> room;
  google::protobuf::ArenaOptions options;
  options.initial_block = room.data();
  options.initial_block_size = room.size();
  google::protobuf::Arena arena(options);
  auto& own = *google::protobuf::Arena::CreateMessage<v1::GetCapabilitiesResponse>(&arena);
  FillQuotas(backend_, caller, *own.mutable_quotas());
  return ToBytes(fixed_[static_cast<std::size_t>(caller.role)], own);
}

}  // namespace flatlight
