// SPDX-License-Identifier: Apache-2.0
#include "server/service/watch_hub.h"

#include <algorithm>

#include "server/service/watcher.h"
#include "server/store/error.h"

namespace flatlight {

WatchHub::WatchHub(const Options& options, JobStore& jobs)
    : options_(options), jobs_(jobs), thread_([this] { Work(); }) {}

WatchHub::~WatchHub() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

absl::Status WatchHub::Add(const JobId& job, const std::shared_ptr<Watcher>& watcher) {
  const std::lock_guard lock(mutex_);
  if (draining_) return MakeError(absl::StatusCode::kUnavailable, "DRAINING", "the server is going down");
  if (count_ >= options_.max_watches) {
    return MakeQuotaError(
        "TOO_MANY_WATCHES", "max_watches",
        std::to_string(count_) + " watches are open; allowed: " + std::to_string(options_.max_watches),
        std::chrono::seconds(2));
  }
  ++count_;
  ++counts_.added;
  watched_[job].watchers.insert(watcher);
  soon_.push_back(watcher);
  wake_.notify_one();
  return absl::OkStatus();
}

void WatchHub::JobChanged(const JobId& job) {
  const std::lock_guard lock(mutex_);
  if (watched_.count(job) == 0) return;
  changed_.insert(job);
  wake_.notify_one();
}

void WatchHub::AccessChanged(const JobId& job) {
  const std::lock_guard lock(mutex_);
  const auto watched = watched_.find(job);
  if (watched == watched_.end()) return;
  for (const auto& watcher : watched->second.watchers) watcher->NoteAccessChange();
  changed_.insert(job);
  wake_.notify_one();
}

void WatchHub::Drain(std::chrono::milliseconds grace) {
  std::unique_lock lock(mutex_);
  draining_ = true;
  for (const auto& [job, watched] : watched_) changed_.insert(job);
  wake_.notify_one();
  left_.wait_for(lock, grace, [this] { return count_ == 0; });
}

bool WatchHub::draining() const {
  const std::lock_guard lock(mutex_);
  return draining_;
}

std::size_t WatchHub::size() const {
  const std::lock_guard lock(mutex_);
  return count_;
}

std::shared_ptr<WatchUpdate> WatchHub::UpdateFor(const JobRecord& job, WatchUpdate::Known known) {
  const std::lock_guard lock(mutex_);
  const auto watched = watched_.find(job.spec->id);
  if (watched == watched_.end()) return std::make_shared<WatchUpdate>(job, options_.epoch, known);
  auto& updates = watched->second.updates;
  if (!updates.empty() && updates.front()->state().sequence < job.state->sequence) updates.clear();
  for (const auto& update : updates) {
    if (update->LeadsTo(*job.state, known)) return update;
  }
  auto update = std::make_shared<WatchUpdate>(job, options_.epoch, known);
  if (updates.empty() || updates.front()->state().sequence == job.state->sequence) updates.push_back(update);
  return update;
}

void WatchHub::StepSoon(const std::shared_ptr<Watcher>& watcher) {
  const std::lock_guard lock(mutex_);
  soon_.push_back(watcher);
  wake_.notify_one();
}

void WatchHub::StepAt(const std::shared_ptr<Watcher>& watcher, Time time) {
  const std::lock_guard lock(mutex_);
  if (watcher->removed) return;
  Unschedule(*watcher);
  watcher->wake_time = time;
  timetable_.emplace(time, watcher);
  if (timetable_.begin()->second == watcher) wake_.notify_one();
}

void WatchHub::Unschedule(Watcher& watcher) {
  if (!watcher.wake_time) return;
  timetable_.erase({*watcher.wake_time, watcher.shared_from_this()});
  watcher.wake_time.reset();
}

void WatchHub::Remove(const JobId& job, const std::shared_ptr<Watcher>& watcher) {
  const std::lock_guard lock(mutex_);
  Unschedule(*watcher);
  watcher->removed = true;
  const auto watched = watched_.find(job);
  watched->second.watchers.erase(watcher);
  if (watched->second.watchers.empty()) watched_.erase(watched);
  --count_;
  left_.notify_all();
}

std::vector<std::shared_ptr<Watcher>> WatchHub::TakeDue() {
  std::vector<std::shared_ptr<Watcher>> due;
  due.swap(soon_);
  for (const JobId& job : changed_) {
    if (const auto watched = watched_.find(job); watched != watched_.end()) {
      due.insert(due.end(), watched->second.watchers.begin(), watched->second.watchers.end());
    }
  }
  changed_.clear();
  const Time now = std::chrono::steady_clock::now();
  while (!timetable_.empty() && timetable_.begin()->first <= now) {
    due.push_back(timetable_.begin()->second);
    Unschedule(*due.back());
  }
  return due;
}

void WatchHub::Work() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    std::vector<std::shared_ptr<Watcher>> due = TakeDue();
    if (due.empty()) {
      if (timetable_.empty()) {
        wake_.wait(lock);
      } else {
        const Time next = timetable_.begin()->first;  // A copy: the entry may go while this waits.
        wake_.wait_until(lock, next);
      }
      continue;
    }
    lock.unlock();
    for (const auto& watcher : due) watcher->Step();
    due.clear();
    lock.lock();
  }
}

}  // namespace flatlight
