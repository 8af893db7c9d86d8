// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_ACCUMULATION_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_ACCUMULATION_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "core/plane/reference/krylov.h"

namespace flatlight {

// What has come of a source of light after some bounces, or all: source + T source + T T source ..., so many terms.
// Goes step by step, each of them one use of T.
class Accumulation {
 public:
  using Values = std::vector<double>;

  // All bounces are summed to `tolerance` of the source, in the norm of `weights`, from the guess `start` on; some
  // bounces until their terms are below `rounding` of the sum.
  Accumulation(Values source, std::optional<std::uint32_t> bounces, Values start, Values weights, double tolerance,
               double rounding);

  // Returns whether it is done.
  bool Step(const LinearMap& transport);

  // Requires that a step returned true.
  const Values& values() const { return minimiser_ ? minimiser_->solution() : values_; }
  // What had come after one bounce less.
  const Values& before() const { return minimiser_ ? minimiser_->solution() : before_; }

 private:
  Values source_, values_, before_;
  std::uint32_t bounces_ = 0;  // Still to come.
  double rounding_;
  std::optional<ResidualMinimiser> minimiser_;  // For all bounces.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_ACCUMULATION_H_
