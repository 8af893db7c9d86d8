// SPDX-License-Identifier: Apache-2.0
#include "server/scheduler/shared_work.h"

namespace flatlight {

std::shared_ptr<JobRun> SharedWork::LeaderFor(const std::shared_ptr<JobRun>& run) {
  if (run->spec->work_key.empty()) return nullptr;
  std::shared_ptr<JobRun>& leader = leaders_[run->spec->work_key];
  const bool may_follow = leader != nullptr && leader != run && leader->spec->job_class <= run->spec->job_class &&
                          leader->state.phase != JobPhase::kPaused && !leader->cancellation.cancelled() &&
                          leader->state.sequence >= run->state.sequence;
  if (may_follow) return leader;
  leader = run;
  return nullptr;
}

void SharedWork::Forget(const JobRun& run) {
  const auto leader = leaders_.find(run.spec->work_key);
  if (leader != leaders_.end() && leader->second.get() == &run) leaders_.erase(leader);
}

std::optional<JobId> SharedWork::Done(const std::string& key) const {
  const auto done = done_.find(key);
  return done == done_.end() ? std::nullopt : std::optional(done->second);
}

void SharedWork::NoteDone(const JobRun& run) {
  const std::string& key = run.spec->work_key;
  if (key.empty()) return;
  if (done_.insert_or_assign(key, run.spec->id).second) done_in_order_.push_back(key);
  if (done_in_order_.size() <= most_done_) return;
  done_.erase(done_in_order_.front());
  done_in_order_.pop_front();
}

}  // namespace flatlight
