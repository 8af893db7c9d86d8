// SPDX-License-Identifier: Apache-2.0
#include "core/plane/irradiance_caching/light_kinks.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace flatlight {
namespace {

// Of the brightest panel's light: what a kink changes over the shorter panel beside it. Polynomials of smooth light
// differ by less.
constexpr double kLeast = 1e-4;

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
    double change = 0;
    for (std::size_t c = 0; c < light.channels(); ++c) {
      const Bend left = BendAt(light.Of(i - 1, c), light.coefficients(), width_before, true);
      const Bend right = BendAt(light.Of(i, c), light.coefficients(), width, false);
      change = std::max(change, std::abs(right[0] - left[0]) +
                                    near * (std::abs(right[1] - left[1]) + 0.5 * near * std::abs(right[2] - left[2])));
    }
    if (change > kLeast * brightest) places_[PanelMesh::IndexOf(panel.element, panel.side)].push_back(panel.low);
  }
}

std::size_t LightKinks::Below(ElementId element, Side side, double u) const {
  const std::vector<double>& places = places_[PanelMesh::IndexOf(element, side)];
  return static_cast<std::size_t>(std::lower_bound(places.begin(), places.end(), u - kSame) - places.begin());
}

}  // namespace flatlight
