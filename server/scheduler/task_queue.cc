// SPDX-License-Identifier: Apache-2.0
#include "server/scheduler/task_queue.h"

#include <utility>

namespace flatlight {

TaskQueue::TaskQueue(int threads, std::size_t max_waiting_bytes) : max_waiting_bytes_(max_waiting_bytes) {
  for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { Work(); });
}

TaskQueue::~TaskQueue() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

bool TaskQueue::Post(std::size_t bytes, std::function<void()> task) {
  {
    const std::lock_guard lock(mutex_);
    if (bytes > max_waiting_bytes_ - waiting_bytes_) return false;
    waiting_bytes_ += bytes;
    tasks_.push_back({bytes, std::move(task)});
  }
  wake_.notify_one();
  return true;
}

void TaskQueue::Work() {
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return stopping_ || !tasks_.empty(); });
    if (tasks_.empty()) return;
    Task task = std::move(tasks_.front());
    tasks_.pop_front();
    waiting_bytes_ -= task.bytes;
    lock.unlock();
    task.run();
    task.run = nullptr;  // What it holds is released without the lock.
    lock.lock();
  }
}

}  // namespace flatlight
