// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_GLOSSY_LIGHT_MAJORANT_H_
#define FLATLIGHT_CORE_PLANE_GLOSSY_LIGHT_MAJORANT_H_

#include <functional>
#include <utility>
#include <vector>

namespace flatlight {

// A bound on w = g + T w for a positive map T that is no larger than linear (T(a + b) <= T a + T b), as "the largest of
// some sums" is: g + T g + T T g ... As soon as one term is at most q < 1 times the term before, everywhere, what
// follows it is at most q/(1 - q) times that term.
class LightMajorant {
 public:
  using Values = std::vector<double>;
  explicit LightMajorant(Values g) : sum_(g), term_(std::move(g)) {}

  // Adds one term; returns whether the bound is there, or never will be.
  bool Step(const std::function<void(const Values& in, Values& out)>& map);
  // Requires that a step returned true. Infinite where terms don't fall.
  const Values& values() const { return sum_; }

 private:
  Values sum_, term_, next_;
  int steps_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_GLOSSY_LIGHT_MAJORANT_H_
