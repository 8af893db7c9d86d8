// SPDX-License-Identifier: Apache-2.0
#include "server/scheduler/metered_executor.h"

#include <ctime>
#include <thread>
#include <utility>

namespace flatlight {

std::int64_t ThreadCpuNanoseconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

MeteredExecutor::MeteredExecutor(Executor& shared) : shared_(shared), owner_start_(ThreadCpuNanoseconds()) {}

void MeteredExecutor::ParallelFor(std::size_t count, int max_threads, const std::function<void(std::size_t)>& work) {
  const std::thread::id owner = std::this_thread::get_id();
  shared_.ParallelFor(count, max_threads, [&](std::size_t i) {
    const bool is_owner = std::this_thread::get_id() == owner;
    const std::int64_t start = is_owner ? 0 : ThreadCpuNanoseconds();
    std::exception_ptr failure;
    try {
      work(i);
    } catch (...) {
      failure = std::current_exception();
    }
    if (is_owner && !failure) return;
    const std::lock_guard lock(mutex_);
    if (!is_owner) others_nanoseconds_ += ThreadCpuNanoseconds() - start;
    if (failure) failure_ = std::move(failure);
  });
  std::exception_ptr failure;
  {
    const std::lock_guard lock(mutex_);
    failure = std::exchange(failure_, nullptr);
  }
  if (failure) std::rethrow_exception(failure);
}

double MeteredExecutor::CpuSeconds() const {
  const std::lock_guard lock(mutex_);
  return static_cast<double>(ThreadCpuNanoseconds() - owner_start_ + others_nanoseconds_) * 1e-9;
}

}  // namespace flatlight
