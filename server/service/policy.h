// SPDX-License-Identifier: Apache-2.0
// Who may do what: the one table that every call is held against, and the rules about whose a job is.
#ifndef FLATLIGHT_SERVER_SERVICE_POLICY_H_
#define FLATLIGHT_SERVER_SERVICE_POLICY_H_

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/store/grants.h"
#include "server/store/job_store.h"
#include "server/store/user_store.h"

namespace flatlight {

struct Caller {
  std::string name;
  Role role = Role::kStudent;
  std::vector<std::string> groups = {};
};

// Each RPC has a request message of its own, by whose name it is found.
struct PolicyRow {
  std::string_view request;  // "CreateJobRequest", of flatlight.v1.
  Role least;                // Who has less is refused.
};
const std::vector<PolicyRow>& Policy();

// OK, or PERMISSION_DENIED with ROLE_TOO_LOW; also where the table has no row.
absl::Status CheckRole(const Caller& caller, std::string_view request);

// Of a job. Each includes those before.
enum class JobRight : std::uint8_t {
  kNone,
  kSee,      // And watch, and fetch: also a grader's of all jobs, and of whom it is shared with.
  kControl,  // And cancel, pause and resume: also of whom it is shared with in this way.
  kOwn       // And delete and share: the owner's; an instructor's and an admin's of all jobs.
};
// Without what is shared.
JobRight RightByRole(const Caller& caller, const JobSpec& job);
absl::StatusOr<JobRight> RightOn(const Caller& caller, const JobSpec& job, JobStore& jobs);

// Jobs that the caller may not see are NOT_FOUND, in the very words of those that are not there.
absl::StatusOr<JobRecord> FindSeen(const Caller& caller, const JobId& id, JobStore& jobs);
// Those that it sees, but without the right, are PERMISSION_DENIED with NOT_YOUR_JOB.
absl::Status CheckRight(const Caller& caller, JobRight right, const JobId& id, JobStore& jobs);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_POLICY_H_
