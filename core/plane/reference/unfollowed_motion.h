// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_UNFOLLOWED_MOTION_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_UNFOLLOWED_MOTION_H_

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "core/plane/reference/brightest_light.h"
#include "core/plane/reference/specular_derivatives.h"

namespace flatlight {

// What is not known of irradiance per radiance, and of its derivatives, over mirrors and through glass: what quadrature
// is off by, and what ways could have brought that were not followed. Their weight says nothing of derivatives, but how
// their ends move does: a narrow one may just come into sight. What is seen in between moves as what is seen elsewhere
// does: its derivatives are as large beside its weight as those of nine tenths of the parts that were seen are. Twice
// both, to be safe.
class UnfollowedMotion {
 public:
  // `lost`: irradiance per radiance.
  UnfollowedMotion(double lost, int derivatives) : lost_(lost), orders_(static_cast<std::size_t>(derivatives) + 1) {}

  void AddUnfollowed(const SpecularDerivatives::Moments& beam) {
    known_ &= beam.known;
    for (std::size_t m = 1; m < orders_; ++m) off_[m] += 2 * beam.of_value[m];
  }
  // A part of what is seen.
  void Add(const SpecularDerivatives::Moments& part) {
    known_ &= part.known;
    for (std::size_t m = 0; m < orders_; ++m) {
      off_[m] += part.error[m];
      if (part.of_value[0] > 0) ratios_[m].push_back(part.of_value[m] / part.of_value[0]);
    }
  }
  // Of the derivative of an order.
  double Of(int order) {
    const auto m = static_cast<std::size_t>(order);
    if (m == 0) return off_[0] + lost_;
    if (!known_) return kUnbounded;
    if (lost_ == 0) return off_[m];
    std::vector<double>& ratios = ratios_[m];
    if (ratios.empty()) return kUnbounded;
    const auto most = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() * 9 / 10);
    std::nth_element(ratios.begin(), most, ratios.end());
    return off_[m] + 2 * lost_ * *most;
  }

 private:
  double lost_;
  std::size_t orders_;
  bool known_ = true;
  std::array<double, 3> off_{};
  std::array<std::vector<double>, 3> ratios_;  // Derivatives beside weights.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_UNFOLLOWED_MOTION_H_
