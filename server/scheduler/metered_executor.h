// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SCHEDULER_METERED_EXECUTOR_H_
#define FLATLIGHT_SERVER_SCHEDULER_METERED_EXECUTOR_H_

#include <cstdint>
#include <exception>
#include <mutex>

#include "absl/base/thread_annotations.h"
#include "core/execution/executor.h"

namespace flatlight {

// Processor time of the calling thread so far. ns.
std::int64_t ThreadCpuNanoseconds();

// One slice of one job on a shared executor: counts the processor time that the slice costs on all threads, and carries
// an exception of a piece of work (out of memory) to the thread that owns the slice, so that it ends the job and not
// the server.
class MeteredExecutor final : public Executor {
 public:
  // To be made and read on the thread that calls ParallelFor.
  explicit MeteredExecutor(Executor& shared);

  int threads() const override { return shared_.threads(); }
  void ParallelFor(std::size_t count, int max_threads, const std::function<void(std::size_t)>& work) override;

  // Since construction: of this thread, and of the pieces that ran on others. s.
  double CpuSeconds() const;

 private:
  Executor& shared_;
  const std::int64_t owner_start_;
  mutable std::mutex mutex_;
  std::int64_t others_nanoseconds_ ABSL_GUARDED_BY(mutex_) = 0;
  std::exception_ptr failure_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SCHEDULER_METERED_EXECUTOR_H_
