// SPDX-License-Identifier: Apache-2.0
#include "client/cli/statistics/interval.h"

#include <cmath>
#include <limits>

#include "client/cli/statistics/distributions.h"

namespace flatlight {

Estimate MeanOf(const Moments& sample) {
  return {sample.mean, std::sqrt(sample.variance / sample.count), static_cast<double>(sample.count - 1)};
}

Estimate Difference(const Estimate& a, const Estimate& b) {
  const double variance_a = a.deviation * a.deviation, variance_b = b.deviation * b.deviation;
  Estimate difference{b.value - a.value, std::sqrt(variance_a + variance_b), 0};
  if (a.degrees <= 0 || b.degrees <= 0) return difference;
  const double spread = variance_a * variance_a / a.degrees + variance_b * variance_b / b.degrees;
  const double variance = variance_a + variance_b;
  // Without any variance the degrees do not matter, but there are some.
  difference.degrees = spread > 0 ? variance * variance / spread : a.degrees + b.degrees;
  return difference;
}

double HalfWidth(const Estimate& estimate, double probability) {
  if (estimate.degrees <= 0) return std::numeric_limits<double>::infinity();
  return estimate.deviation == 0 ? 0 : estimate.deviation * StudentQuantile(probability, estimate.degrees);
}

}  // namespace flatlight
