// SPDX-License-Identifier: Apache-2.0
#include "core/statistics/misses_in_row.h"

#include <algorithm>
#include <cmath>

namespace flatlight {
namespace {

constexpr std::size_t kNeighbours = 16;  // On either side.

}  // namespace

MissesInRow::MissesInRow(std::span<const std::optional<RowPoint>> row)
    : row_(row), missable_(row.size()), misses_(row.size()) {
  for (std::size_t point = 0; point < row_.size(); ++point) {
    if (!row_[point]) continue;
    Missable& missable = missable_[point];
    missable.largest = row_[point]->step;
    const auto [begin, end] = Neighbours(point);
    double count = 0;
    for (std::size_t p = begin; p < end; ++p) {
      if (!row_[p]) continue;
      ++count;
      // An event that one of n values met makes (1 - 1/n) times its square.
      const Spread all = row_[p]->spread.All();
      missable.seen = std::max(missable.seen, std::sqrt(all.squares * all.count / (all.count - 1)));
    }
    missable.seen = std::min(missable.seen, missable.largest);
    missable.share = 1 / std::sqrt(count);
    misses_[point].Add(row_[point]->spread, missable.Event());
  }
}

std::pair<std::size_t, std::size_t> MissesInRow::Neighbours(std::size_t point) const {
  return {point - std::min(point, kNeighbours), std::min(row_.size(), point + kNeighbours + 1)};
}

MeanEstimate MissesInRow::Estimate(std::size_t point) const {
  SharedMisses misses;
  const auto [begin, end] = Neighbours(point);
  for (std::size_t p = begin; p < end; ++p) misses.Add(misses_[p]);
  const Spread all = row_[point]->spread.All();
  const Missable& missable = missable_[point];
  NearbyVariance nearby;
  nearby.missed = misses.MeanSquare((misses.any() ? missable.Event() : missable.largest) / (all.count / 2));
  if (nearby.missed) {
    // A shadow's edge is met by a point that its neighbours know nothing of: any of them may be the one.
    const double edge = missable.share * MostMissed(missable.largest, all.count);
    *nearby.missed += edge * edge;
  }
  return EstimateMean(all, missable, nearby);
}

}  // namespace flatlight
