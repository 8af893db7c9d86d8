// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_EXECUTION_THREAD_POOL_H_
#define FLATLIGHT_CORE_EXECUTION_THREAD_POOL_H_

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "core/execution/executor.h"

namespace flatlight {

// An executor with threads of its own. Every caller of ParallelFor works along, so a pool of n threads starts n - 1,
// and a loop always proceeds, even one that was started from inside another. Free threads go to the loop that has
// fewest.
class ThreadPool final : public Executor {
 public:
  // `threads` >= 1; fewer are used if the system refuses to start more.
  explicit ThreadPool(int threads);
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;
  // No ParallelFor may be running.
  ~ThreadPool() override;

  int threads() const override { return static_cast<int>(workers_.size()) + 1; }
  void ParallelFor(std::size_t count, int max_threads, const std::function<void(std::size_t)>& work) override;

  // The processors that this process may use, at least 1.
  static int AvailableProcessors();

 private:
  struct Loop {
    const std::function<void(std::size_t)>* work = nullptr;
    std::size_t count = 0;
    int max_helpers = 0;
    std::atomic<std::size_t> next = 0;
    int helpers = 0;  // Pool threads inside Run; guarded by mutex_.
  };

  static void Run(Loop& loop);
  Loop* FindWork();  // Requires mutex_.
  void WorkerMain();

  std::mutex mutex_;
  std::condition_variable work_added_;
  std::condition_variable helper_left_;
  std::vector<Loop*> loops_;  // Guarded by mutex_.
  bool stopping_ = false;     // Guarded by mutex_.
  std::vector<std::thread> workers_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_EXECUTION_THREAD_POOL_H_
