// SPDX-License-Identifier: Apache-2.0
// Of Scheduler: jobs that do the same work.
#include <algorithm>
#include <utility>

#include "server/scheduler/scheduler.h"

namespace flatlight {

void Scheduler::FollowOrWait(const RunPtr& run) {
  const RunPtr leader = stopping_ ? nullptr : shared_work_.LeaderFor(run);
  if (leader == nullptr) {
    // Nobody is to wait for tomorrow because of another one.
    if (IsSpent(run->spec->owner)) shared_work_.Forget(*run);
    waiting_.Push(run->Entry(), run);
    return Admit();
  }
  run->stage = JobRun::Stage::kFollowing;
  run->leader = leader;
  leader->followers.push_back(run);
  Adopt(leader->state, *run);
  Store(*run);
}

void Scheduler::Adopt(const JobState& other, JobRun& run) {
  const std::optional<WallTime> start_time = run.state.start_time;
  const double cpu_seconds = run.state.cpu_seconds;
  run.state = other;
  run.state.cpu_seconds = cpu_seconds;
  run.state.shared_work = true;
  run.state.start_time = start_time;
  if (other.start_time && !start_time) run.state.start_time = std::chrono::system_clock::now();
  run.state.elapsed_seconds = std::chrono::duration<double>(run.stopwatch.Now() - run.started).count();
}

void Scheduler::Unfollow(JobRun& run) {
  std::erase_if(run.leader->followers, [&](const RunPtr& follower) { return follower.get() == &run; });
  run.leader.reset();
  run.stage = JobRun::Stage::kWaiting;
  run.state.phase = JobPhase::kQueued;
  run.state.start_time.reset();
  run.state.queue.reset();
}

void Scheduler::SendAway(JobRun& leader) {
  shared_work_.Forget(leader);
  for (const RunPtr& follower : std::vector<RunPtr>(leader.followers)) {
    Unfollow(*follower);
    Publish(*follower);
    FollowOrWait(follower);
  }
}

std::shared_ptr<const JobState> Scheduler::StateOfDone(const JobSpec& spec) {
  std::optional<JobId> done;
  {
    const std::lock_guard lock(mutex_);
    done = shared_work_.Done(spec.work_key);
  }
  // What this process does not remember, the store may.
  if (!done && !spec.work_key.empty()) done = store_.FindDone(spec.work_key);
  if (!done) return nullptr;
  const auto job = store_.GetWhole(*done);
  if (!job.ok() || job->state->phase != JobPhase::kSucceeded || job->state->field == nullptr) return nullptr;
  return job->state;
}

}  // namespace flatlight
