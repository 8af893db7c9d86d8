// SPDX-License-Identifier: Apache-2.0
// Time is passed in, so that tests own it.
#ifndef FLATLIGHT_CORE_EXECUTION_CLOCK_H_
#define FLATLIGHT_CORE_EXECUTION_CLOCK_H_

#include <chrono>

namespace flatlight {

class Clock {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;
  virtual ~Clock() = default;
  virtual Time Now() const = 0;
};

class SteadyClock final : public Clock {
 public:
  Time Now() const override { return std::chrono::steady_clock::now(); }
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_EXECUTION_CLOCK_H_
