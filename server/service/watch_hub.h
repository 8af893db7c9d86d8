// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_WATCH_HUB_H_
#define FLATLIGHT_SERVER_SERVICE_WATCH_HUB_H_

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "server/service/watch_update.h"
#include "server/store/job_store.h"

namespace flatlight {

class Watch;

// All watches, and the one thread that moves those on whose subject has changed or whose time has come. A subject is
// named as callers name it: "jobs/{uuid}".
class WatchHub {
 public:
  using Time = std::chrono::steady_clock::time_point;

  struct Options {
    std::uint64_t epoch = 0;
    std::size_t max_watches = 2000;
    std::chrono::milliseconds heartbeat{10'000};
    // A watcher that takes longer for one of several messages lets go of their state, and begins anew with the newest.
    std::chrono::milliseconds stall{30'000};
    // Another number whenever somebody may have ceased to be a user; asked every `users_interval` while there are
    // watches. Then each asks whether its own watcher still is one. Null: that never happens.
    std::function<std::int64_t()> users_version = nullptr;
    std::chrono::milliseconds users_interval{500};
  };

  // Since the start.
  struct Counts {
    std::atomic<std::uint64_t> added = 0;
    std::atomic<std::uint64_t> resumed = 0;    // Of those: with a known state.
    std::atomic<std::uint64_t> updates = 0;    // Complete states sent.
    std::atomic<std::uint64_t> conflated = 0;  // States between those.
  };

  WatchHub(const Options& options, JobStore& jobs);
  // All watches must be gone.
  ~WatchHub();

  const Options& options() const { return options_; }
  JobStore& jobs() { return jobs_; }

  // RESOURCE_EXHAUSTED at the limit of all watches, or at that of its watcher's (absent: none); UNAVAILABLE while
  // draining.
  absl::Status Add(const std::string& subject, const std::shared_ptr<Watch>& watch,
                   std::optional<std::uint32_t> most_of_watcher);
  void Changed(const std::string& subject);
  // Watches that rest on what is shared ask anew whether they may go on.
  void AccessChanged(const std::string& subject);
  // Tells every watch that the server goes down; waits until all have gone, at most `grace`.
  void Drain(std::chrono::milliseconds grace);

  // For watches.
  bool draining() const;
  // Watches that are open.
  std::size_t size() const;
  std::size_t SizeOf(const std::string& watcher) const;
  bool IsWatched(const std::string& subject) const;
  Counts& counts() { return counts_; }
  std::shared_ptr<WatchUpdate> UpdateFor(const JobRecord& job, WatchUpdate::Known known);
  void StepSoon(const std::shared_ptr<Watch>& watch);
  void StepAt(const std::shared_ptr<Watch>& watch, Time time);
  void Remove(const std::string& subject, const std::shared_ptr<Watch>& watch);

 private:
  struct Watched {
    std::set<std::shared_ptr<Watch>> watches;
    std::vector<std::shared_ptr<WatchUpdate>> updates;  // Of a job: to the newest state that was asked for.
  };

  void Work();
  // Moves all watches that are to be stepped now to the caller.
  std::vector<std::shared_ptr<Watch>> TakeDue() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void Unschedule(Watch& watch) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // If it is time, and they may have changed: all watches are to be stepped.
  void MaybeLookAtUsers(std::unique_lock<std::mutex>& lock) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const Options options_;
  JobStore& jobs_;
  Counts counts_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable left_;
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;
  bool draining_ ABSL_GUARDED_BY(mutex_) = false;
  std::size_t count_ ABSL_GUARDED_BY(mutex_) = 0;
  std::unordered_map<std::string, std::uint32_t> count_of_ ABSL_GUARDED_BY(mutex_);  // By watcher; none of 0.
  std::unordered_map<std::string, Watched> watched_ ABSL_GUARDED_BY(mutex_);
  std::unordered_set<std::string> changed_ ABSL_GUARDED_BY(mutex_);
  std::vector<std::shared_ptr<Watch>> soon_ ABSL_GUARDED_BY(mutex_);
  std::set<std::pair<Time, std::shared_ptr<Watch>>> timetable_ ABSL_GUARDED_BY(mutex_);  // One entry a watch.
  // The thread's alone.
  Time next_look_;
  std::optional<std::int64_t> users_version_;
  std::thread thread_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_WATCH_HUB_H_
