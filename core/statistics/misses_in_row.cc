// SPDX-License-Identifier: Apache-2.0
#include "core/statistics/misses_in_row.h"

#include <algorithm>

namespace flatlight {

std::pair<std::size_t, std::size_t> NeighboursInRow(std::size_t point, std::size_t points, std::size_t reach) {
  return {point - std::min(point, reach), std::min(points, point + reach + 1)};
}

MissesInRow::MissesInRow(std::vector<std::optional<RowPoint>> row) : row_(std::move(row)), misses_(row_.size()) {
  for (std::size_t p = 0; p < row_.size(); ++p)
    if (row_[p] && row_[p]->missable.largest > 0)
      misses_[p].Add(row_[p]->spread, row_[p]->missable.Event(), row_[p]->ratio);
}

std::optional<double> MissesInRow::At(std::size_t point) const {
  SharedMisses misses;
  const auto [begin, end] = NeighboursInRow(point, row_.size(), kNeighbours);
  for (std::size_t p = begin; p < end; ++p) misses.Add(misses_[p]);
  const RowPoint& own = *row_[point];
  const double of_half = own.spread.first.count;
  std::optional<double> missed =
      misses.MeanSquare((misses.any() ? own.missable.Event() : own.missable.largest) / of_half);
  if (!missed) return missed;
  // A shadow's edge is met by a point that its neighbours know nothing of: any of them may be the one.
  const double edge = own.missable.share * MostMissed(own.edge, 2 * of_half);
  return *missed + edge * edge;
}

}  // namespace flatlight
