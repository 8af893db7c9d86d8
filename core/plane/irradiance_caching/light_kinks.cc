// SPDX-License-Identifier: Apache-2.0
#include "core/plane/irradiance_caching/light_kinks.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace flatlight {
namespace {

// Of the brightest panel's light: what a kink changes over the shorter panel beside it.
constexpr double kStrong = 1e-4;
// The same where polynomials are so good that a weaker one stands out; less is rounding.
constexpr double kWeakest = 1e-9;

// So near to a kink an end of what is seen is not beyond it: where a curve stands on another one it stays there, to
// rounding.
constexpr double kSame = 1e-9;

// Value, slope and second derivative by the number of the chart.
using Bend = std::array<double, 3>;

// At the low end, where x = -1, or at the high one.
Bend BendAt(const double* coefficients, std::size_t count, double width, bool high) {
  Bend bend{};
  double sign = 1;
  for (std::size_t k = 0; k < count; ++k) {
    const double n = static_cast<double>(k), turns = n * (n + 1);
    // P_n(1) = 1, P_n'(1) = n (n + 1)/2, P_n''(1) = (n - 1) n (n + 1) (n + 2)/8; P_n is even or odd as n is.
    bend[0] += sign * coefficients[k];
    bend[1] += (high ? sign : -sign) * coefficients[k] * 0.5 * turns;
    bend[2] += sign * coefficients[k] * turns * (turns - 2) / 8;
    if (!high) sign = -sign;
  }
  bend[1] *= 2 / width, bend[2] *= 4 / (width * width);
  return bend;
}

// How much of what seems to change over a length at its end is but the end of the panel's series.
double Unknown(const double* coefficients, std::size_t count, double width, double length) {
  constexpr double kOfOneBefore = 0.1;
  std::array<double, kLightCoefficients> rest{};
  rest[count - 1] = std::abs(coefficients[count - 1]) + kOfOneBefore * std::abs(coefficients[count - 2]);
  const Bend bend = BendAt(rest.data(), count, width, true);
  return bend[0] + length * (bend[1] + 0.5 * length * bend[2]);
}

}  // namespace

LightKinks::LightKinks(std::size_t elements, const PanelMesh& mesh, const PanelLight& light) : places_(2 * elements) {
  double brightest = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i)
    for (std::size_t c = 0; c < light.channels(); ++c) brightest = std::max(brightest, light.Of(i, c)[0]);
  for (std::size_t i = 1; i < mesh.size(); ++i) {
    const Panel &before = mesh.panels()[i - 1], &panel = mesh.panels()[i];
    if (before.element != panel.element || before.side != panel.side) continue;
    const double width_before = before.high - before.low, width = panel.high - panel.low;
    const double near = std::min(width_before, width);
    bool is_kink = false;
    for (std::size_t c = 0; c < light.channels(); ++c) {
      const Bend left = BendAt(light.Of(i - 1, c), light.coefficients(), width_before, true);
      const Bend right = BendAt(light.Of(i, c), light.coefficients(), width, false);
      const double change = std::abs(right[0] - left[0]) +
                            near * (std::abs(right[1] - left[1]) + 0.5 * near * std::abs(right[2] - left[2]));
      const double unknown = Unknown(light.Of(i - 1, c), light.coefficients(), width_before, near) +
                             Unknown(light.Of(i, c), light.coefficients(), width, near);
      is_kink = is_kink || change > std::min(kStrong * brightest, std::max(kWeakest * brightest, unknown));
    }
    if (is_kink) places_[PanelMesh::IndexOf(panel.element, panel.side)].push_back(panel.low);
  }
}

std::size_t LightKinks::Below(ElementId element, Side side, double u) const {
  const std::vector<double>& places = places_[PanelMesh::IndexOf(element, side)];
  return static_cast<std::size_t>(std::lower_bound(places.begin(), places.end(), u - kSame) - places.begin());
}

}  // namespace flatlight
