// SPDX-License-Identifier: Apache-2.0
// Finds the segments near a place, for checks and for making scenes; not for speed records.
#ifndef FLATLIGHT_TESTS_BENCH_SEGMENT_GRID_H_
#define FLATLIGHT_TESTS_BENCH_SEGMENT_GRID_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/math/vec.h"
#include "core/scene/description.h"

namespace flatlight {

// A grid of square cells over the unit square; what lies outside belongs to the cells at its border.
class SegmentGrid {
 public:
  explicit SegmentGrid(int cells_a_side)
      : side_(std::max(1, cells_a_side)), cells_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_)) {}

  void Add(std::uint32_t index, const SegmentDescription& segment) {
    ForEachCell(segment.a, segment.b, [&](std::vector<std::uint32_t>& cell) {
      cell.push_back(index);
      return true;
    });
  }

  // Calls visit(index) for all segments that meet the box around two points, and for others nearby, for some more than
  // once, until it says false.
  template <typename Visit>
  void ForEachNear(Point2 p, Point2 q, Visit visit) {
    ForEachCell(p, q, [&](const std::vector<std::uint32_t>& cell) {
      return std::all_of(cell.begin(), cell.end(), [&](std::uint32_t index) { return visit(index); });
    });
  }

 private:
  int CellOf(double coordinate) const {
    return std::min(static_cast<int>(std::clamp(coordinate, 0.0, 1.0) * side_), side_ - 1);
  }

  // The cells that the box around two points reaches into.
  template <typename Visit>
  void ForEachCell(Point2 p, Point2 q, Visit visit) {
    const int x1 = CellOf(std::max(p.x, q.x)), y1 = CellOf(std::max(p.y, q.y));
    for (int y = CellOf(std::min(p.y, q.y)); y <= y1; ++y)
      for (int x = CellOf(std::min(p.x, q.x)); x <= x1; ++x)
        if (!visit(cells_[static_cast<std::size_t>(y) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(x)]))
          return;
  }

  int side_;
  std::vector<std::vector<std::uint32_t>> cells_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_BENCH_SEGMENT_GRID_H_
