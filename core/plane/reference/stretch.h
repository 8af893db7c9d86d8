// SPDX-License-Identifier: Apache-2.0
// Integrals over what a receiver sees of an element: quadrature that knows how near the receiver is.
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_STRETCH_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_STRETCH_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/math/vec.h"
#include "core/plane/reference/chart.h"
#include "core/plane/reference/quadrature.h"
#include "core/scene/scene.h"

namespace flatlight {

// How many Gauss points a stretch needs. The kernel is analytic within the ellipse whose foci are the ends of the
// stretch and on which the receiver lies; a rule of n points is off by about the (2 n - degree)-th power of its size.
class PointCount {
 public:
  // For polynomials of a degree times the kernel, to `digits` decimal digits.
  PointCount(std::size_t degree, int digits);
  // For both.
  PointCount(const PointCount& a, const PointCount& b);
  static constexpr double kNearest = 1.6;  // Sum of the distances to the ends over the stretch's length.
  // Requires roundness >= kNearest.
  std::size_t For(double roundness) const {
    std::size_t n = least_;
    while (n < kMostGaussPoints && roundness < roundness_[n]) ++n;
    return n;
  }

 private:
  std::size_t least_;
  std::array<double, kMostGaussPoints + 1> roundness_{};  // From which on so many points do.
};

// Calls add(u, place, weight) at Gauss points of [low, high] of a chart; weights are arc lengths. Where even halves of
// halves are too near to the receiver, it calls rest(u, low, high).
template <typename Add, typename Rest>
void ForEachPoint(const Chart& chart, Point2 x, bool own_circle, const PointCount& count, double low, double high,
                  int depth, const Add& add, const Rest& rest) {
  if (!(low < high)) return;
  std::size_t n;
  if (own_circle) {
    n = count.For(3);
  } else {
    const double roundness = chart.Roundness(x, low, high);
    if (!(roundness >= PointCount::kNearest)) {
      const double middle = 0.5 * (low + high);
      if (depth >= 48 || !(low < middle && middle < high)) return rest(middle, low, high);
      ForEachPoint(chart, x, false, count, low, middle, depth + 1, add, rest);
      ForEachPoint(chart, x, false, count, middle, high, depth + 1, add, rest);
      return;
    }
    n = count.For(roundness);
  }
  const GaussRule& rule = Gauss(n);
  const double half = 0.5 * (high - low);
  for (std::size_t i = 0; i < n; ++i) {
    const double u = 0.5 * ((1 - rule.node[i]) * low + (1 + rule.node[i]) * high);
    const Chart::Place place = chart.At(u);
    add(u, place, half * rule.weight[i] * place.speed);
  }
}

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_STRETCH_H_
