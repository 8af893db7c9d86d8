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
  }
  double known() const { return std::max(std::abs(known_), std::sqrt(known_squares_)); }
  double missed() const { return std::max(kAlike * missed_, std::sqrt(missed_squares_)); }
  double total() const { return known() + missed(); }

 private:
  static constexpr double kAlike = 0.4;
  double known_ = 0, known_squares_ = 0, missed_ = 0, missed_squares_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_ERROR_SUM_H_
