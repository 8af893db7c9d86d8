// SPDX-License-Identifier: Apache-2.0
#include "core/statistics/shared_misses.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/math/check.h"

namespace flatlight {

void SharedMisses::Add(const HalvesSpread& values, double event, double ratio) {
  const std::array<Spread, 2> halves = {values.first, values.second};
  const double n = values.first.count;
  FLATLIGHT_DCHECK(n >= 2 && values.second.count == n);
  const double off = halves[0].mean - halves[1].mean;
  const double variances = ratio * (halves[0].squares + halves[1].squares) / (n * (n - 1));
  for (std::size_t h = 0; h < 2; ++h) {
    if (!Agree(halves[h].squares, event)) continue;
    points_ += 0.5;
    // Where both agree nothing was met: what they differ by is the noise of either.
    if (Agree(halves[1 - h].squares, event)) continue;
    squares_ += 0.5 * (off * off - variances);
    offs_ += 0.5 * (halves[1 - h].mean - halves[h].mean);
  }
}

void SharedMisses::Add(const SharedMisses& other) {
  points_ += other.points_;
  squares_ += other.squares_;
  offs_ += other.offs_;
}

std::optional<double> SharedMisses::MeanSquare(double step) const {
  if (points_ == 0) return std::nullopt;
  const double met = std::max(offs_, 0.0);
  return std::max(squares_ / points_, (met + step) / points_ * (met + 2 * step) / points_);
}

}  // namespace flatlight
