// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_JOB_SWEEPER_H_
#define FLATLIGHT_SERVER_SERVICE_JOB_SWEEPER_H_

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "server/store/job.h"
#include "server/store/job_store.h"
#include "server/store/retention.h"

namespace flatlight {

// Removes jobs that have expired, on a thread of its own, a bounded number at a time.
class JobSweeper {
 public:
  struct Options {
    Retention retention;
    std::chrono::milliseconds interval{0};  // Between looks. 0: a hundredth of the shortest time, 1 s to 10 min.
    std::size_t most_at_once = 500;         // Of a look; if that was not enough, the next one comes a second later.
    std::function<WallTime()> now = std::chrono::system_clock::now;
  };
  struct Hooks {
    std::function<bool(const JobId&)> is_needed;       // Somebody looks at it: it is kept until nobody does.
    std::function<absl::Status(const JobId&)> remove;  // With all that it holds.
    std::function<void(const JobSpec&)> removed;
  };
  // Works from now on, unless all classes are kept for ever. What is passed in must outlive the sweeper.
  JobSweeper(Options options, JobStore& jobs, Hooks hooks);
  // As Close.
  ~JobSweeper();
  void Close();

 private:
  void Work();
  // Returns whether it may have left some.
  bool Sweep();
  std::chrono::milliseconds Interval() const;
  bool stopping();

  const Options options_;
  JobStore& jobs_;
  const Hooks hooks_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_JOB_SWEEPER_H_
