// SPDX-License-Identifier: Apache-2.0
#include "core/execution/thread_pool.h"

#include <sched.h>

#include <algorithm>
#include <system_error>

namespace flatlight {

ThreadPool::ThreadPool(int threads) {
  try {
    for (int i = 1; i < threads; ++i) workers_.emplace_back([this] { WorkerMain(); });
  } catch (const std::system_error&) {
    // The system's limit on threads: the pool works with those it has.
  }
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  work_added_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::ParallelFor(std::size_t count, int max_threads, const std::function<void(std::size_t)>& work) {
  if (count == 0) return;
  Loop loop;
  loop.work = &work;
  loop.count = count;
  const std::size_t wanted = std::min(count, static_cast<std::size_t>(std::max(max_threads, 1))) - 1;
  loop.max_helpers = static_cast<int>(std::min(wanted, workers_.size()));
  if (loop.max_helpers == 0) {
    Run(loop);
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    loops_.push_back(&loop);
  }
  if (loop.max_helpers == 1) {
    work_added_.notify_one();
  } else {
    work_added_.notify_all();
  }
  Run(loop);
  std::unique_lock lock(mutex_);
  loops_.erase(std::find(loops_.begin(), loops_.end(), &loop));
  helper_left_.wait(lock, [&loop] { return loop.helpers == 0; });
}

int ThreadPool::AvailableProcessors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof(set), &set) == 0) return std::max(CPU_COUNT(&set), 1);
  return std::max(static_cast<int>(std::thread::hardware_concurrency()), 1);
}

void ThreadPool::Run(Loop& loop) {
  while (true) {
    const std::size_t index = loop.next.fetch_add(1, std::memory_order_relaxed);
    if (index >= loop.count) return;
    (*loop.work)(index);
  }
}

ThreadPool::Loop* ThreadPool::FindWork() {
  Loop* found = nullptr;
  for (Loop* loop : loops_) {
    if (loop->helpers >= loop->max_helpers || loop->next.load(std::memory_order_relaxed) >= loop->count) continue;
    if (found == nullptr || loop->helpers < found->helpers) found = loop;
  }
  return found;
}

void ThreadPool::WorkerMain() {
  std::unique_lock lock(mutex_);
  while (true) {
    Loop* loop = nullptr;
    work_added_.wait(lock, [&] { return (loop = FindWork()) != nullptr || stopping_; });
    if (loop == nullptr) return;
    ++loop->helpers;
    lock.unlock();
    Run(*loop);
    lock.lock();
    if (--loop->helpers == 0) helper_left_.notify_all();
  }
}

}  // namespace flatlight
