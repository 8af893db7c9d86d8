// SPDX-License-Identifier: Apache-2.0
#include "core/plane/materials/cosine_lobe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math/power.h"
#include "core/math/trig.h"

namespace flatlight {

double CosinePowerIntegral(double power) {
  // W(m) = W(m + 2) (m + 2)/(m + 1) up to where Stirling's series serves.
  double factor = 1;
  double m = power;
  for (; m < 60; m += 2) factor *= (m + 2) / (m + 1);
  // sqrt(2 pi/x) times a series in 1/x^2, x = m + 1/2: the ratio Gamma(y + 1/4)/Gamma(y + 3/4), y = x/2, has an
  // expansion of even terms (Tricomi and Erdelyi 1951). The first term left out is 2.5/x^10, below 1e-17.
  const double z = 1 / (m + 0.5) / (m + 0.5);
  const double series = 1 + z * (-1.0 / 16 + z * (21.0 / 512 + z * (-671.0 / 8192 + z * (180323.0 / 524288))));
  return factor * std::sqrt(2 * std::numbers::pi / (m + 0.5)) * series;
}

double CosineLobe::PowerOfAlpha(LocalDirection out, LocalDirection in) const {
  const LocalDirection mirror = Mirrored(out);
  const double cos_alpha = mirror.cosine * in.cosine + mirror.sine * in.sine;
  return cos_alpha > 0 && in.cosine > 0 ? UnitPower(std::min(cos_alpha, 1.0), exponent_) : 0;
}

// sin(alpha) has density proportional to (1 - x^2)^((n-1)/2): a symmetric beta distribution, drawn after Ulrich (1984,
// "Computer generation of distributions on the m-sphere") as sqrt(1 - u^(2/n)) cos(2 pi v).
std::optional<LocalDirection> CosineLobe::Sample(LocalDirection out, double u, double v) const {
  const SinCosValue turn = SinCos(2 * std::numbers::pi * v);
  // u^(2/n), and 1 minus it without cancellation where it matters: both squares below are sums of positive terms.
  const double power = UnitPower(u, 2 / exponent_);
  const double sin_alpha = std::sqrt(1 - power) * turn.cos;
  const double cos_alpha = std::sqrt(turn.sin * turn.sin + power * turn.cos * turn.cos);
  const LocalDirection mirror = Mirrored(out);
  const LocalDirection in{mirror.sine * cos_alpha + mirror.cosine * sin_alpha,
                          mirror.cosine * cos_alpha - mirror.sine * sin_alpha};
  if (!(in.cosine > 0)) return std::nullopt;
  return in;
}

}  // namespace flatlight
