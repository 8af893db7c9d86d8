// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_EXECUTION_EXECUTOR_H_
#define FLATLIGHT_CORE_EXECUTION_EXECUTOR_H_

#include <cstddef>
#include <functional>

namespace flatlight {

// Runs independent pieces of work. Which thread runs which piece, and in what order, must not matter to the caller.
class Executor {
 public:
  virtual ~Executor() = default;
  virtual int threads() const = 0;
  // Calls work(0) ... work(count - 1), each once, on at most `max_threads` threads (the caller's included), and returns
  // when all have returned. `work` must not throw. May be called from several threads at once.
  virtual void ParallelFor(std::size_t count, int max_threads, const std::function<void(std::size_t)>& work) = 0;
};

// Everything on the calling thread.
class InlineExecutor final : public Executor {
 public:
  int threads() const override { return 1; }
  void ParallelFor(std::size_t count, int /*max_threads*/, const std::function<void(std::size_t)>& work) override {
    for (std::size_t i = 0; i < count; ++i) work(i);
  }
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_EXECUTION_EXECUTOR_H_
