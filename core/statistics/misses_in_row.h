// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_STATISTICS_MISSES_IN_ROW_H_
#define FLATLIGHT_CORE_STATISTICS_MISSES_IN_ROW_H_

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/statistics/replicates.h"
#include "core/statistics/shared_misses.h"

namespace flatlight {

// So many points on either side get light in much the same ways.
inline constexpr std::size_t kNeighbours = 16;

// The points [first, last) of a row of `points` that are near: up to `reach` on either side.
std::pair<std::size_t, std::size_t> NeighboursInRow(std::size_t point, std::size_t points, std::size_t reach);

// A point of a row.
struct RowPoint {
  HalvesSpread spread;  // Of its values.
  Missable missable;    // By a value.
  double edge = 0;      // By how much an edge of a shadow may change a value.
  double ratio = 1;     // VarianceRatio::ratio.
};

// Points in a row: where the values of one agree, what its neighbours met and missed tells what it may have missed.
class MissesInRow {
 public:
  // Points without values tell nothing.
  explicit MissesInRow(std::vector<std::optional<RowPoint>> row);
  // Mean square of what the values of a point that has some are off by together, should they agree; absent if nothing
  // is known of it.
  std::optional<double> At(std::size_t point) const;

 private:
  std::vector<std::optional<RowPoint>> row_;
  std::vector<SharedMisses> misses_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_STATISTICS_MISSES_IN_ROW_H_
