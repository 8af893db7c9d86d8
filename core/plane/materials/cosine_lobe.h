// SPDX-License-Identifier: Apache-2.0
// The lobe cos^n(alpha) about the mirror direction, for angles |alpha| < pi/2, n > 0 (THEORY 2, 17 A5).
#ifndef FLATLIGHT_CORE_PLANE_MATERIALS_COSINE_LOBE_H_
#define FLATLIGHT_CORE_PLANE_MATERIALS_COSINE_LOBE_H_

#include <optional>

#include "core/plane/materials/local_direction.h"

namespace flatlight {

// Integral of cos^power over a half circle, = sqrt(pi) Gamma((power + 1)/2)/Gamma(power/2 + 1), to 1e-15 of itself.
// power >= 0.
double CosinePowerIntegral(double power);

class CosineLobe {
 public:
  explicit CosineLobe(double exponent)
      : exponent_(exponent),
        integral_(CosinePowerIntegral(exponent)),
        energy_integral_(CosinePowerIntegral(exponent + 1)) {}

  // BRDF over reflectance, 1/rad: reflects all light at normal incidence. Both directions in front.
  double Value(LocalDirection out, LocalDirection in) const { return PowerOfAlpha(out, in) / energy_integral_; }
  // Of Sample: per radian of `in`.
  double Density(LocalDirection out, LocalDirection in) const { return PowerOfAlpha(out, in) / integral_; }
  // By two numbers in [0, 1). Absent where the lobe dips below the curve: that sample counts, and is worth nothing.
  std::optional<LocalDirection> Sample(LocalDirection out, double u, double v) const;

 private:
  double PowerOfAlpha(LocalDirection out, LocalDirection in) const;

  double exponent_;
  double integral_;
  double energy_integral_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_MATERIALS_COSINE_LOBE_H_
