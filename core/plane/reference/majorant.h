// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_MAJORANT_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_MAJORANT_H_

#include <optional>
#include <vector>

#include "core/plane/reference/krylov.h"

namespace flatlight {

// Bounds on the solution of w = source + T w for a source that is not negative and a T that keeps what is positive so:
// some w with w >= source + T w everywhere, whatever the solver left over. It is solved until what w lacks is little of
// the source; where it is more, w is raised by a multiple of the solution of p = 1 + T p (THEORY 18 B8, 2).
class Majorant {
 public:
  using Values = std::vector<double>;

  // `weights`: of squares in norms. T 1 <= `reflectance` everywhere.
  Majorant(Values source, Values weights, double reflectance);

  // One use of T. Returns whether the bounds are there.
  bool Step(const LinearMap& transport);
  // Requires that a step returned true. Infinite where nothing bounds them.
  const Values& bounds() const { return bounds_; }

 private:
  bool Look(const LinearMap& transport);
  void LookAtUniform(const LinearMap& transport);
  void Raise(double lack);

  Values source_, weights_;
  double reflectance_;
  double tolerance_;
  int solves_ = 0;
  Values bounds_;
  Values uniform_;            // p, and
  Values kept_;               // p - T p, above 0; empty until they are needed.
  bool for_uniform_ = false;  // The minimiser works on p.
  std::optional<ResidualMinimiser> minimiser_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_MAJORANT_H_
