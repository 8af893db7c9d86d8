// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_TESTS_SUPPORT_RENDERING_FAKE_CLOCK_H_
#define FLATLIGHT_TESTS_SUPPORT_RENDERING_FAKE_CLOCK_H_

#include <mutex>

#include "core/execution/clock.h"

namespace flatlight::testing {

// Stands still until a test moves it.
class FakeClock final : public Clock {
 public:
  Time Now() const override {
    const std::lock_guard lock(mutex_);
    return now_;
  }
  void Advance(Duration duration) {
    const std::lock_guard lock(mutex_);
    now_ += duration;
  }

 private:
  mutable std::mutex mutex_;
  Time now_{std::chrono::hours(1000)};
};

}  // namespace flatlight::testing

#endif  // FLATLIGHT_TESTS_SUPPORT_RENDERING_FAKE_CLOCK_H_
