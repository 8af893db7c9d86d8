// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_PANEL_LIGHT_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_PANEL_LIGHT_H_

#include <cstddef>
#include <vector>

#include "core/plane/reference/quadrature.h"

namespace flatlight {

// Light on a panel is a polynomial of so many coefficients, right at as many Gauss points; what it is off by between
// them one of so many.
inline constexpr std::size_t kLightCoefficients = 8;
inline constexpr std::size_t kResidualCoefficients = 2 * kLightCoefficients + 1;
// Decimal digits to which integrals over panels are right.
inline constexpr int kKernelDigits = 15;

// Reflected radiance: on each panel of a mesh and in each channel a sum of Legendre polynomials.
class PanelLight {
 public:
  PanelLight() = default;
  PanelLight(std::size_t panels, std::size_t channels, std::size_t coefficients)
      : channels_(channels), coefficients_(coefficients), values_(panels * channels * coefficients, 0.0) {}

  std::size_t channels() const { return channels_; }
  std::size_t coefficients() const { return coefficients_; }
  double* Of(std::size_t panel, std::size_t channel) { return &values_[(panel * channels_ + channel) * coefficients_]; }
  const double* Of(std::size_t panel, std::size_t channel) const {
    return &values_[(panel * channels_ + channel) * coefficients_];
  }
  // p: Legendre polynomials, or their slopes, at the place.
  double At(std::size_t panel, std::size_t channel, const double* p) const {
    const double* c = Of(panel, channel);
    double sum = 0;
    for (std::size_t k = 0; k < coefficients_; ++k) sum += c[k] * p[k];
    return sum;
  }

 private:
  std::size_t channels_ = 0;
  std::size_t coefficients_ = 0;
  std::vector<double> values_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_PANEL_LIGHT_H_
