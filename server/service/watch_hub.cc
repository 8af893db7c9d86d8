// SPDX-License-Identifier: Apache-2.0
#include "server/service/watch_hub.h"

#include <algorithm>

#include "server/service/watch.h"
#include "server/store/error.h"

namespace flatlight {
namespace {

constexpr std::chrono::seconds kRetryLater{2};

}  // namespace

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

absl::Status WatchHub::Add(const std::string& subject, const std::shared_ptr<Watch>& watch,
                           std::optional<std::uint32_t> most_of_watcher) {
  const std::lock_guard lock(mutex_);
  if (draining_) return MakeDrainingError();
  if (count_ >= options_.max_watches) {
    return MakeQuotaError(
        "TOO_MANY_WATCHES", "max_watches",
        std::to_string(count_) + " watches are open; allowed: " + std::to_string(options_.max_watches), kRetryLater);
  }
  if (most_of_watcher) {
    const auto own = count_of_.find(watch->watcher());
    const std::uint32_t open = own == count_of_.end() ? 0 : own->second;
    if (open >= *most_of_watcher) {
      return MakeQuotaError("TOO_MANY_OWN_WATCHES", "max_watches_per_user",
                            std::to_string(open) + " of your watches are open; allowed: " +
                                std::to_string(*most_of_watcher) + ". End one first",
                            kRetryLater, QuotaUse{static_cast<double>(open), static_cast<double>(*most_of_watcher)});
    }
  }
  ++count_;
  ++count_of_[watch->watcher()];
  ++counts_.added;
  watched_[subject].watches.insert(watch);
  soon_.push_back(watch);
  wake_.notify_one();
  return absl::OkStatus();
}

void WatchHub::Changed(const std::string& subject) {
  const std::lock_guard lock(mutex_);
  if (watched_.count(subject) == 0) return;
  changed_.insert(subject);
  wake_.notify_one();
}

void WatchHub::AccessChanged(const std::string& subject) {
  const std::lock_guard lock(mutex_);
  const auto watched = watched_.find(subject);
  if (watched == watched_.end()) return;
  for (const auto& watch : watched->second.watches) watch->NoteAccessChange();
  changed_.insert(subject);
  wake_.notify_one();
}

void WatchHub::Drain(std::chrono::milliseconds grace) {
  std::unique_lock lock(mutex_);
  draining_ = true;
  for (const auto& [subject, watched] : watched_) changed_.insert(subject);
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

bool WatchHub::IsWatched(const std::string& subject) const {
  const std::lock_guard lock(mutex_);
  const auto watched = watched_.find(subject);
  return watched != watched_.end() && !watched->second.watches.empty();
}

std::size_t WatchHub::SizeOf(const std::string& watcher) const {
  const std::lock_guard lock(mutex_);
  const auto own = count_of_.find(watcher);
  return own == count_of_.end() ? 0 : own->second;
}

std::shared_ptr<WatchUpdate> WatchHub::UpdateFor(const JobRecord& job, WatchUpdate::Known known) {
  const std::lock_guard lock(mutex_);
  const auto watched = watched_.find(job.spec->id.Name());
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

void WatchHub::StepSoon(const std::shared_ptr<Watch>& watch) {
  const std::lock_guard lock(mutex_);
  soon_.push_back(watch);
  wake_.notify_one();
}

void WatchHub::StepAt(const std::shared_ptr<Watch>& watch, Time time) {
  const std::lock_guard lock(mutex_);
  if (watch->removed) return;
  Unschedule(*watch);
  watch->wake_time = time;
  timetable_.emplace(time, watch);
  if (timetable_.begin()->second == watch) wake_.notify_one();
}

void WatchHub::Unschedule(Watch& watch) {
  if (!watch.wake_time) return;
  timetable_.erase({*watch.wake_time, watch.shared_from_this()});
  watch.wake_time.reset();
}

void WatchHub::Remove(const std::string& subject, const std::shared_ptr<Watch>& watch) {
  const std::lock_guard lock(mutex_);
  Unschedule(*watch);
  watch->removed = true;
  const auto watched = watched_.find(subject);
  watched->second.watches.erase(watch);
  if (watched->second.watches.empty()) watched_.erase(watched);
  --count_;
  if (const auto own = count_of_.find(watch->watcher()); --own->second == 0) count_of_.erase(own);
  left_.notify_all();
}

std::vector<std::shared_ptr<Watch>> WatchHub::TakeDue() {
  std::vector<std::shared_ptr<Watch>> due;
  due.swap(soon_);
  for (const std::string& subject : changed_) {
    if (const auto watched = watched_.find(subject); watched != watched_.end()) {
      due.insert(due.end(), watched->second.watches.begin(), watched->second.watches.end());
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

void WatchHub::MaybeLookAtUsers(std::unique_lock<std::mutex>& lock) {
  if (!options_.users_version || count_ == 0) return;
  const Time now = std::chrono::steady_clock::now();
  if (now < next_look_) return;
  next_look_ = now + options_.users_interval;
  lock.unlock();
  const std::int64_t version = options_.users_version();
  lock.lock();
  if (users_version_ == version) return;
  users_version_ = version;
  for (const auto& [subject, watched] : watched_) {
    for (const auto& watch : watched.watches) {
      watch->NoteUsersChange();
      soon_.push_back(watch);
    }
  }
}

void WatchHub::Work() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    MaybeLookAtUsers(lock);
    std::vector<std::shared_ptr<Watch>> due = TakeDue();
    if (due.empty()) {
      Time next = Time::max();
      if (!timetable_.empty()) next = timetable_.begin()->first;
      if (count_ > 0 && options_.users_version) next = std::min(next, next_look_);
      if (next == Time::max()) {
        wake_.wait(lock);
      } else {
        wake_.wait_until(lock, next);
      }
      continue;
    }
    lock.unlock();
    for (const auto& watch : due) watch->Step();
    due.clear();
    lock.lock();
  }
}

}  // namespace flatlight
