// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SCHEDULER_TASK_QUEUE_H_
#define FLATLIGHT_SERVER_SCHEDULER_TASK_QUEUE_H_

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "absl/base/thread_annotations.h"

namespace flatlight {

// Runs tasks in order on a few threads. What waits is bounded by the bytes it holds.
class TaskQueue {
 public:
  TaskQueue(int threads, std::size_t max_waiting_bytes);
  // Runs what still waits, then returns.
  ~TaskQueue();

  // Returns false, and drops the task, if more than the allowed bytes would wait.
  bool Post(std::size_t bytes, std::function<void()> task);

 private:
  struct Task {
    std::size_t bytes = 0;
    std::function<void()> run;
  };
  void Work();

  const std::size_t max_waiting_bytes_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Task> tasks_ ABSL_GUARDED_BY(mutex_);
  std::size_t waiting_bytes_ ABSL_GUARDED_BY(mutex_) = 0;
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SCHEDULER_TASK_QUEUE_H_
