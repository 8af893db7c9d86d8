// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_CALLS_UNDER_WAY_H_
#define FLATLIGHT_SERVER_SERVICE_CALLS_UNDER_WAY_H_

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>

#include "absl/base/thread_annotations.h"

namespace flatlight {

// Counts calls, so that a server that goes down knows when the last one has its answer. (gRPC's own shutdown also waits
// for idle connections, whose clients may not be listening.)
class CallsUnderWay {
 public:
  // The call is under way as long as a copy of this lives.
  using Ticket = std::shared_ptr<void>;

  Ticket Enter() {
    const std::lock_guard lock(mutex_);
    ++count_;
    return Ticket(this, [](void* calls) { static_cast<CallsUnderWay*>(calls)->Leave(); });
  }

  void AwaitNone(std::chrono::milliseconds at_most) {
    std::unique_lock lock(mutex_);
    none_.wait_for(lock, at_most, [this] { return count_ == 0; });
  }

 private:
  void Leave() {
    const std::lock_guard lock(mutex_);
    if (--count_ == 0) none_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable none_;
  int count_ ABSL_GUARDED_BY(mutex_) = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_CALLS_UNDER_WAY_H_
