// SPDX-License-Identifier: Apache-2.0
#include "server/service/job_sweeper.h"

#include <algorithm>
#include <utility>

namespace flatlight {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLeastInterval{1000};
constexpr milliseconds kMostInterval{600'000};
constexpr std::size_t kPage = 100;

}  // namespace

JobSweeper::JobSweeper(Options options, JobStore& jobs, Hooks hooks)
    : options_(std::move(options)), jobs_(jobs), hooks_(std::move(hooks)) {
  const auto& keep = options_.retention.keep;
  if (std::any_of(keep.begin(), keep.end(), [](const auto& kept) { return kept.has_value(); })) {
    thread_ = std::thread([this] { Work(); });
  }
}

JobSweeper::~JobSweeper() { Close(); }

void JobSweeper::Close() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

milliseconds JobSweeper::Interval() const {
  if (options_.interval.count() > 0) return options_.interval;
  milliseconds interval = kMostInterval;
  for (const auto& kept : options_.retention.keep) {
    if (kept) interval = std::min(interval, milliseconds(*kept) / 100);
  }
  return std::max(interval, kLeastInterval);
}

bool JobSweeper::stopping() {
  const std::lock_guard lock(mutex_);
  return stopping_;
}

void JobSweeper::Work() {
  const milliseconds interval = Interval();
  while (true) {
    const bool more = Sweep();
    std::unique_lock lock(mutex_);
    if (wake_.wait_for(lock, more ? std::min(interval, kLeastInterval) : interval, [&] { return stopping_; })) return;
  }
}

bool JobSweeper::Sweep() {
  std::size_t removed = 0;
  for (std::size_t i = 0; i < kJobClasses; ++i) {
    const auto job_class = static_cast<JobClass>(i);
    const auto kept = options_.retention.Of(job_class);
    if (!kept) continue;
    std::size_t skip = 0;  // Those that are left.
    while (true) {
      const auto expired = jobs_.EndedBefore(job_class, options_.now() - *kept, skip, kPage);
      if (!expired.ok() || expired->empty()) break;
      for (const JobId& id : *expired) {
        if (stopping()) return false;
        if (removed == options_.most_at_once) return true;
        const auto job = jobs_.Get(id);
        if (hooks_.is_needed(id) || !hooks_.remove(id).ok()) {
          ++skip;
          continue;
        }
        ++removed;
        if (job.ok()) hooks_.removed(*job->spec);
      }
    }
  }
  return false;
}

}  // namespace flatlight
