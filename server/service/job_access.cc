// SPDX-License-Identifier: Apache-2.0
#include "server/service/job_access.h"

#include <utility>

#include "server/store/error.h"

namespace flatlight {
namespace {

// What may be done with a job, of those who may not do all.
const char* Rest(JobRight right) {
  return right == JobRight::kControl ? "you may control it, but not delete, share or show it"
                                     : "you may watch it, but not change or show it";
}

}  // namespace

JobRight RightByRole(const Caller& caller, const JobSpec& job) {
  if (job.owner == caller.name || caller.role >= Role::kInstructor) return JobRight::kOwn;
  return caller.role >= Role::kGrader ? JobRight::kSee : JobRight::kNone;
}

absl::StatusOr<JobRight> JobAccess::RightOn(const Caller& caller, const JobSpec& job) const {
  const JobRight by_role = RightByRole(caller, job);
  if (by_role == JobRight::kOwn) return by_role;
  const std::vector<Grantee> who = Grantee::Of(caller.name, caller.groups);
  const auto grants = jobs_.GrantsOf(job.id);
  if (!grants.ok()) return grants.status();
  const auto access = AccessOf(*grants, who);
  if (access == Access::kControl) return JobRight::kControl;
  if (access || by_role == JobRight::kSee) return JobRight::kSee;
  const auto shown = rooms_.Shows(job.id, {caller.name, who});
  if (!shown.ok()) return shown.status();
  return *shown ? JobRight::kSee : JobRight::kNone;
}

absl::StatusOr<JobAccess::Seen> JobAccess::Find(const Caller& caller, const JobId& id) const {
  auto job = jobs_.Get(id);
  if (!job.ok()) return job.status();
  const auto right = RightOn(caller, *job->spec);
  if (!right.ok()) return right.status();
  if (*right == JobRight::kNone) return NoSuchJob(id);
  return Seen{*std::move(job), *right};
}

absl::StatusOr<JobRecord> JobAccess::FindSeen(const Caller& caller, const JobId& id) const {
  auto seen = Find(caller, id);
  if (!seen.ok()) return seen.status();
  return std::move(seen->job);
}

absl::Status JobAccess::CheckRight(const Caller& caller, JobRight right, const JobId& id) const {
  const auto seen = Find(caller, id);
  if (!seen.ok()) return seen.status();
  if (seen->right >= right) return absl::OkStatus();
  return MakeError(absl::StatusCode::kPermissionDenied, "NOT_YOUR_JOB",
                   id.Name() + " is not yours: " + Rest(seen->right));
}

}  // namespace flatlight
