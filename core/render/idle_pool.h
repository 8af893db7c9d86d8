// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_IDLE_POOL_H_
#define FLATLIGHT_CORE_RENDER_IDLE_POOL_H_

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace flatlight {

// Things that keep their working memory from one use to the next: there are as many as were ever used at once.
template <typename T>
class IdlePool {
 public:
  // An idle one, or what make() returns, a unique_ptr.
  template <typename Make>
  std::unique_ptr<T> Take(Make make) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!idle_.empty()) {
        std::unique_ptr<T> taken = std::move(idle_.back());
        idle_.pop_back();
        return taken;
      }
    }
    return make();
  }

  void Return(std::unique_ptr<T> taken) {
    const std::lock_guard<std::mutex> lock(mutex_);
    idle_.push_back(std::move(taken));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<T>> idle_;  // Guarded by mutex_.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_IDLE_POOL_H_
