// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_STATISTICS_MISSES_IN_ROW_H_
#define FLATLIGHT_CORE_STATISTICS_MISSES_IN_ROW_H_

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/statistics/replicates.h"
#include "core/statistics/shared_misses.h"

namespace flatlight {

// A point of a row: its values, and the most by which an event that they may have missed would change one of them.
struct RowPoint {
  HalvesSpread spread;
  double step = 0;
};

// Points in a row, which get light in much the same ways: where the values of one agree, what its neighbours met and
// missed tells what it may have missed itself.
class MissesInRow {
 public:
  // Points without values tell nothing. The row must outlive this.
  explicit MissesInRow(std::span<const std::optional<RowPoint>> row);
  // Of a point that has values.
  MeanEstimate Estimate(std::size_t point) const;

 private:
  std::pair<std::size_t, std::size_t> Neighbours(std::size_t point) const;

  std::span<const std::optional<RowPoint>> row_;
  std::vector<Missable> missable_;
  std::vector<SharedMisses> misses_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_STATISTICS_MISSES_IN_ROW_H_
