// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/stretch.h"

namespace flatlight {
namespace {

// The n-th root of a number above 1.
double Root(double number, std::size_t n) {
  double low = 1, high = number;
  for (int step = 0; step < 80; ++step) {
    const double middle = 0.5 * (low + high);
    double power = 1;
    for (std::size_t i = 0; i < n && power <= number; ++i) power *= middle;
    (power <= number ? low : high) = middle;
  }
  return high;
}

}  // namespace

PointCount::PointCount(std::size_t degree, int digits) : least_(std::max<std::size_t>(degree / 2 + 2, 4)) {
  double accuracy = 1;
  for (int i = 0; i < digits; ++i) accuracy *= 10;
  for (std::size_t n = 0; n <= kMostGaussPoints; ++n) {
    if (2 * n <= degree) continue;
    const double axes = Root(accuracy, 2 * n - degree);
    roundness_[n] = 0.5 * (axes + 1 / axes);
  }
}

PointCount::PointCount(const PointCount& a, const PointCount& b) : least_(std::max(a.least_, b.least_)) {
  for (std::size_t n = 0; n <= kMostGaussPoints; ++n) roundness_[n] = std::max(a.roundness_[n], b.roundness_[n]);
}

}  // namespace flatlight
