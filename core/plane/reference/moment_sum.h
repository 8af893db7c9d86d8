// SPDX-License-Identifier: Apache-2.0
// Integrals of Legendre polynomials over a panel, from weighted points.
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_MOMENT_SUM_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_MOMENT_SUM_H_

#include <array>
#include <cstddef>

#include "core/plane/reference/panel_light.h"

namespace flatlight {

// Sums of weights times polynomials: the first kLightCoefficients, or kResidualCoefficients if `high`. Works on several
// points at once, which is faster.
class MomentSum {
 public:
  explicit MomentSum(bool high) : count_(high ? kResidualCoefficients : kLightCoefficients) {}

  // x: the place on the panel, in [-1, 1].
  void Add(double x, double weight) {
    x_[waiting_] = x, weight_[waiting_] = weight;
    if (++waiting_ == kTogether) Flush();
  }
  // By polynomial, `count` of them. Nothing is to be added afterwards.
  const double* Finish();

 private:
  static constexpr std::size_t kTogether = 4;

  void Flush();

  std::size_t count_;
  std::size_t waiting_ = 0;
  std::array<double, kTogether> x_{}, weight_{};
  std::array<double, kResidualCoefficients> sum_{};
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_MOMENT_SUM_H_
