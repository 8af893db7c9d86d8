// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_JOB_CONVERT_H_
#define FLATLIGHT_SERVER_SERVICE_JOB_CONVERT_H_

#include <string>

#include "absl/status/statusor.h"
#include "flatlight/v1/render_service.pb.h"
#include "flatlight/v1/result.pb.h"
#include "server/store/grants.h"
#include "server/store/job.h"

namespace flatlight {

enum class JobView : std::uint8_t { kWhole, kChanging };

// Names what decides a result's bits: world, probes, settings and build.
std::string JobKey(const JobSpec& spec, const std::string& build);

// kChanging leaves out what never changes: scene, settings, plan.
v1::Job JobToProto(const JobSpec& spec, const JobState& state, JobView view);

// By their texts; INVALID_ARGUMENT, with the place `path`, of others.
absl::StatusOr<Grantee> GranteeFromProto(const std::string& path, const std::string& text);
absl::StatusOr<Grant> GrantFromProto(const v1::Share& share);
v1::Share GrantToProto(const Grant& grant);

// FAILED_PRECONDITION if the job has not ended, or ended without a picture.
absl::StatusOr<v1::RenderResult> MakeResult(const JobRecord& job, const std::string& build);

// INVALID_ARGUMENT if `name` is not jobs/{uuid}.
absl::StatusOr<JobId> ParseJobName(const std::string& name);

// INTERACTIVE if it is not said; INVALID_ARGUMENT of a class that is unknown.
absl::StatusOr<JobClass> JobClassFromProto(v1::JobClass job_class);

v1::JobClass JobClassToProto(JobClass job_class);

void SetTime(WallTime time, google::protobuf::Timestamp& out);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_JOB_CONVERT_H_
