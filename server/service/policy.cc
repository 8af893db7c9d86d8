// SPDX-License-Identifier: Apache-2.0
#include "server/service/policy.h"

#include <algorithm>
#include <utility>

#include "server/store/error.h"

namespace flatlight {
namespace {

absl::Status Denied(const std::string& reason, const std::string& message) {
  return MakeError(absl::StatusCode::kPermissionDenied, reason, message);
}

}  // namespace

const std::vector<PolicyRow>& Policy() {
  static const std::vector<PolicyRow> kPolicy = {
      // Whose the job is decides the rest: FindSeen, CheckRight.
      {"CreateJobRequest", Role::kStudent},
      {"GetJobRequest", Role::kStudent},
      {"ListJobsRequest", Role::kStudent},
      {"WatchJobRequest", Role::kStudent},
      {"GetResultRequest", Role::kStudent},
      {"CancelJobRequest", Role::kStudent},
      {"PauseJobRequest", Role::kStudent},
      {"ResumeJobRequest", Role::kStudent},
      {"DeleteJobRequest", Role::kStudent},
      {"ShareJobRequest", Role::kStudent},
      {"UnshareJobRequest", Role::kStudent},
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

JobRight RightByRole(const Caller& caller, const JobSpec& job) {
  if (job.owner == caller.name || caller.role >= Role::kInstructor) return JobRight::kOwn;
  return caller.role >= Role::kGrader ? JobRight::kSee : JobRight::kNone;
}

absl::StatusOr<JobRight> RightOn(const Caller& caller, const JobSpec& job, JobStore& jobs) {
  const JobRight by_role = RightByRole(caller, job);
  if (by_role == JobRight::kOwn) return by_role;
  const auto grants = jobs.GrantsOf(job.id);
  if (!grants.ok()) return grants.status();
  const auto access = AccessOf(*grants, Grantee::Of(caller.name, caller.groups));
  if (!access) return by_role;
  return *access == Access::kControl ? JobRight::kControl : JobRight::kSee;
}

absl::StatusOr<JobRecord> FindSeen(const Caller& caller, const JobId& id, JobStore& jobs) {
  auto job = jobs.Get(id);
  if (!job.ok()) return job;
  const auto right = RightOn(caller, *job->spec, jobs);
  if (!right.ok()) return right.status();
  return *right == JobRight::kNone ? NoSuchJob(id) : std::move(job);
}

absl::Status CheckRight(const Caller& caller, JobRight right, const JobId& id, JobStore& jobs) {
  const auto job = FindSeen(caller, id, jobs);
  if (!job.ok()) return job.status();
  const auto has = RightOn(caller, *job->spec, jobs);
  if (!has.ok()) return has.status();
  if (*has >= right) return absl::OkStatus();
  return Denied("NOT_YOUR_JOB", id.Name() + (*has == JobRight::kControl
                                                 ? " is not yours: you may control it, but not delete or share it"
                                                 : " is not yours: you may watch it, but not change it"));
}

}  // namespace flatlight
