// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_EXECUTION_CANCELLATION_H_
#define FLATLIGHT_CORE_EXECUTION_CANCELLATION_H_

#include <atomic>

namespace flatlight {

// A request to stop, made from any thread. Work asks for it at least every few milliseconds.
class Cancellation {
 public:
  void Cancel() { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }

 private:
  std::atomic<bool> cancelled_ = false;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_EXECUTION_CANCELLATION_H_
