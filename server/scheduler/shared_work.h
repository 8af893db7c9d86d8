// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SCHEDULER_SHARED_WORK_H_
#define FLATLIGHT_SERVER_SCHEDULER_SHARED_WORK_H_

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>

#include "server/scheduler/job_run.h"
#include "server/store/job_id.h"

namespace flatlight {

// Who does the work of a key (JobSpec::work_key), or has done it: so that it is done once.
class SharedWork {
 public:
  // `most_done`: so many that are done are remembered, the latest.
  explicit SharedWork(std::size_t most_done) : most_done_(most_done) {}

  // The run that does the same work, if `run` may follow it: not one that is less urgent, rests or is being cancelled,
  // and not one whose states are numbered lower than those that watchers of `run` have seen. Otherwise null, and `run`
  // is the one to follow from now on.
  std::shared_ptr<JobRun> LeaderFor(const std::shared_ptr<JobRun>& run);
  // Nobody is to follow `run` any more.
  void Forget(const JobRun& run);

  // The job that has done the work last; nothing if none is known.
  std::optional<JobId> Done(const std::string& key) const;
  void NoteDone(const JobRun& run);

 private:
  const std::size_t most_done_;
  std::unordered_map<std::string, std::shared_ptr<JobRun>> leaders_;
  std::unordered_map<std::string, JobId> done_;
  std::deque<std::string> done_in_order_;  // The keys of `done_`, the oldest first.
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SCHEDULER_SHARED_WORK_H_
