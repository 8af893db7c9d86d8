// SPDX-License-Identifier: Apache-2.0
#include "core/plane/triangulation/hilbert.h"

#include <algorithm>
#include <utility>

namespace flatlight {
namespace {

constexpr int kBits = 16;

std::uint32_t Step(double value, double low, double high) {
  constexpr double kSteps = 1u << kBits;
  const double share = high > low ? (value - low) / (high - low) : 0;
  return static_cast<std::uint32_t>(std::clamp(share * kSteps, 0.0, kSteps - 1));
}

}  // namespace

std::uint32_t HilbertKey(const Box& box, Point2 p) {
  std::uint32_t x = Step(p.x, box.low.x, box.high.x), y = Step(p.y, box.low.y, box.high.y);
  std::uint32_t key = 0;
  for (std::uint32_t half = 1u << (kBits - 1); half > 0; half /= 2) {
    const bool right = (x & half) != 0, upper = (y & half) != 0;
    // The quarters in turn: lower left, upper left, upper right, lower right.
    key = 4 * key + (right ? (upper ? 2u : 3u) : (upper ? 1u : 0u));
    x &= half - 1, y &= half - 1;
    if (!upper) {
      if (right) x = half - 1 - x, y = half - 1 - y;
      std::swap(x, y);
    }
  }
  return key;
}

}  // namespace flatlight
