// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_JOB_ACCESS_H_
#define FLATLIGHT_SERVER_SERVICE_JOB_ACCESS_H_

#include <cstdint>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/review/room_store.h"
#include "server/service/policy.h"
#include "server/store/job_store.h"

namespace flatlight {

// Of a job. Each includes those before.
enum class JobRight : std::uint8_t {
  kNone,
  kSee,      // And watch, and fetch: also a grader's of all jobs, and of whom it is shared with or shown to in a review
             // room.
  kControl,  // And cancel, pause and resume: also of whom it is shared with in this way.
  kOwn       // And delete, share and show: the owner's; an instructor's and an admin's of all jobs.
};

// Without what is shared and shown.
JobRight RightByRole(const Caller& caller, const JobSpec& job);

// Whose a job is, with whom it is shared and where it is shown decide what callers may do with it.
class JobAccess {
 public:
  JobAccess(JobStore& jobs, RoomStore& rooms) : jobs_(jobs), rooms_(rooms) {}

  absl::StatusOr<JobRight> RightOn(const Caller& caller, const JobSpec& job) const;
  // Jobs that the caller may not see are NOT_FOUND, in the very words of those that are not there.
  absl::StatusOr<JobRecord> FindSeen(const Caller& caller, const JobId& id) const;
  // Those that it sees, but without the right, are PERMISSION_DENIED with NOT_YOUR_JOB.
  absl::Status CheckRight(const Caller& caller, JobRight right, const JobId& id) const;

 private:
  struct Seen {
    JobRecord job;
    JobRight right;
  };
  absl::StatusOr<Seen> Find(const Caller& caller, const JobId& id) const;

  JobStore& jobs_;
  RoomStore& rooms_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_JOB_ACCESS_H_
