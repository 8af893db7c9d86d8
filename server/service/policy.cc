// SPDX-License-Identifier: Apache-2.0
#include "server/service/policy.h"

#include <algorithm>

#include "server/store/error.h"

namespace flatlight {
namespace {

absl::Status Denied(const std::string& reason, const std::string& message) {
  return MakeError(absl::StatusCode::kPermissionDenied, reason, message);
}

}  // namespace

const std::vector<PolicyRow>& Policy() {
  static const std::vector<PolicyRow> kPolicy = {
      // Whose the job is decides the rest: FindSeen, CheckControl.
      {"CreateJobRequest", Role::kStudent},
      {"GetJobRequest", Role::kStudent},
      {"ListJobsRequest", Role::kStudent},
      {"WatchJobRequest", Role::kStudent},
      {"GetResultRequest", Role::kStudent},
      {"CancelJobRequest", Role::kStudent},
      {"PauseJobRequest", Role::kStudent},
      {"ResumeJobRequest", Role::kStudent},
      {"DeleteJobRequest", Role::kStudent},
      {"ExplainJobRequest", Role::kStudent},
      // An uploaded scene is named by the hash of its bytes: who knows the name has had the scene. Students are not
      // listed the uploads, and do not delete what another may have uploaded too.
      {"UploadSceneRequest", Role::kStudent},
      {"GetSceneRequest", Role::kStudent},
      {"ListScenesRequest", Role::kStudent},
      {"DeleteSceneRequest", Role::kInstructor},
      {"ValidateSceneRequest", Role::kStudent},
      {"GetCapabilitiesRequest", Role::kStudent},
      {"GetActivityRequest", Role::kStudent},  // Students see others only as numbers.
  };
  return kPolicy;
}

absl::Status CheckRole(const Caller& caller, std::string_view request) {
  const auto& rows = Policy();
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const PolicyRow& r) { return r.request == request; });
  if (row == rows.end()) return Denied("ROLE_TOO_LOW", "this call is open to nobody");
  if (caller.role >= row->least) return absl::OkStatus();
  return Denied("ROLE_TOO_LOW", "this call is for the role " + std::string(RoleName(row->least)) + " and above; " +
                                    caller.name + " is a " + std::string(RoleName(caller.role)));
}

bool MaySee(const Caller& caller, const JobSpec& job) {
  return caller.role >= Role::kGrader || job.owner == caller.name;
}

bool MayControl(const Caller& caller, const JobSpec& job) {
  return caller.role >= Role::kInstructor || job.owner == caller.name;
}

absl::StatusOr<JobRecord> FindSeen(const Caller& caller, const JobId& id, JobStore& jobs) {
  auto job = jobs.Get(id);
  if (job.ok() && !MaySee(caller, *job->spec)) return NoSuchJob(id);
  return job;
}

absl::Status CheckControl(const Caller& caller, const JobId& id, JobStore& jobs) {
  const auto job = FindSeen(caller, id, jobs);
  if (!job.ok()) return job.status();
  if (MayControl(caller, *job->spec)) return absl::OkStatus();
  return Denied("NOT_YOUR_JOB", id.Name() + " is not yours: you may watch it, but not change it");
}

}  // namespace flatlight
