// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_ERROR_SUM_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_ERROR_SUM_H_

#include <algorithm>
#include <cmath>

namespace flatlight {

// What the residuals of panels come to at a point. Their polynomials are known with their signs; at a point they may
// cancel by chance, but near it do so no better than what has either sign. What they miss is known in size only: of one
// panel all of it may count, of many that are alike it is less, for it is a bound on each that few come near to.
class ErrorSum {
 public:
  void Add(double known, double missed) {
    known_ += known, known_squares_ += known * known;
    missed_ += missed, missed_squares_ += missed * missed;
    most_missed_ = std::max(most_missed_, missed);
  }
  // With its sign.
  double sum() const { return known_; }
  double known() const { return std::max(std::abs(known_), std::sqrt(known_squares_)); }
  double missed() const { return std::max(kAlike * missed_, std::sqrt(missed_squares_)); }
  // What is left when the sum is taken for light. Polynomials through twice as many points are off by a fourth of what
  // they say that half of the points are off by, where light has kinks; half is allowed for.
  double rest() const { return kRest * known() + std::max(most_missed_, kMany * std::sqrt(missed_squares_)); }
  // The same for a part by itself.
  static double RestOf(double known, double missed) { return kRest * std::abs(known) + missed; }
  // When it is not. Residuals are known at points only, and may be larger.
  double total() const { return kCaution * known() + missed(); }
  static constexpr double kCaution = 2;

 private:
  static constexpr double kRest = 0.5, kMany = 0.5, kAlike = 0.4;
  double known_ = 0, known_squares_ = 0, missed_ = 0, missed_squares_ = 0, most_missed_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_ERROR_SUM_H_
