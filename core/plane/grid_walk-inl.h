// SPDX-License-Identifier: Apache-2.0
// The walk of a line through a grid of curves: included once for every vector unit (see ray_walk.cc).
#if defined(FLATLIGHT_CORE_PLANE_GRID_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FLATLIGHT_CORE_PLANE_GRID_WALK_INL_H_
#undef FLATLIGHT_CORE_PLANE_GRID_WALK_INL_H_
#else
#define FLATLIGHT_CORE_PLANE_GRID_WALK_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/plane/curve_grid.h"
#include "core/plane/intersect.h"

HWY_BEFORE_NAMESPACE();
namespace flatlight {
namespace HWY_NAMESPACE {

// Where a ray is in a grid: its cell, and the distances at which it leaves the column and the row.
struct GridPlace {
  std::uint32_t cell;
  std::int32_t next_column, next_row;  // Added to the cell's number.
  double to_column, to_row;
  double column_length, row_length;
  double limit;  // Where the ray leaves the cell that the grid is in: beyond, the grid does not know all.
};

class GridWalk {
 public:
  GridWalk() = default;
  HWY_INLINE explicit GridWalk(const Line& line)
      : origin_(line.origin), direction_(line.direction), inverse_{Inverse(direction_.x), Inverse(direction_.y)} {}

  // The place where the walk to `end` begins; false if the grid is not on the way.
  HWY_INLINE bool Begin(const CurveGrid& grid, double end, GridPlace& at) const {
    return Enter(grid.frames()[0], 0, std::numeric_limits<double>::infinity(), end, at);
  }

  // Calls search.Meet(world, cell) for cells with curves from near to far, until it answers true or search.end(),
  // which may come nearer, is reached. Not by a function object: GCC would not inline it, and the search would be in
  // memory, not in registers.
  template <typename World, typename Search>
  HWY_INLINE void Run(const World& world, GridPlace at, Search& search) const {
    const CurveGrid& grid = world.grid;
    const GridCell* const cells = grid.cells().data();
    GridPlace around[CurveGrid::kMostLevels];
    std::size_t level = 0;
    while (true) {
      const GridCell cell = cells[at.cell];
      double leave = std::min(at.to_column, at.to_row);
      if (cell.kind <= GridCell::kCurves) {
        if (search.Meet(world, cell)) return;
      } else if (cell.kind == GridCell::kEmpty) {
        if (cell.count > 0) leave = Skip(cell.count, at);
      } else if (cell.kind == GridCell::kGrid) {
        const double begin = std::max({0.0, at.to_column - at.column_length, at.to_row - at.row_length});
        around[level++] = at;
        if (Enter(grid.frames()[cell.first], begin, std::min(leave, at.limit), search.end(), at)) continue;
        at = around[--level];
      } else {
        leave = at.limit;
      }
      while (HWY_UNLIKELY(leave >= at.limit)) {
        if (level == 0 || search.end() <= at.limit) return;
        at = around[--level];
        leave = std::min(at.to_column, at.to_row);
      }
      if (search.end() <= leave) return;
      Step(at);
    }
  }

 private:
  // Never infinite, so that nothing becomes NaN.
  static HWY_INLINE double Inverse(double component) {
    return std::copysign(std::min(1 / std::abs(component), 1e200), component);
  }

  // From `begin` on; false if the grid is not on the way to the limit or `end`.
  HWY_INLINE bool Enter(const GridFrame& frame, double begin, double limit, double end, GridPlace& at) const {
    const double to_low_x = frame.low.x - origin_.x, to_low_y = frame.low.y - origin_.y;
    const double x0 = to_low_x * inverse_.x, y0 = to_low_y * inverse_.y;
    const double x1 = (to_low_x + frame.columns * frame.side.x) * inverse_.x;
    const double y1 = (to_low_y + frame.rows * frame.side.y) * inverse_.y;
    const double enter = std::max(std::max(begin, std::min(x0, x1)), std::min(y0, y1));
    const double leave = std::min(std::max(x0, x1), std::max(y0, y1));
    if (!(enter <= std::min({leave, limit, end}))) return false;
    at.limit = limit;
    const double last_column = static_cast<double>(frame.columns - 1), last_row = static_cast<double>(frame.rows - 1);
    const double x = (enter * direction_.x - to_low_x) * frame.inverse_side.x;
    const double y = (enter * direction_.y - to_low_y) * frame.inverse_side.y;
    const auto column = static_cast<std::int32_t>(std::min(std::max(x, 0.0), last_column));
    const auto row = static_cast<std::int32_t>(std::min(std::max(y, 0.0), last_row));
    const bool right = !std::signbit(direction_.x), up = !std::signbit(direction_.y);
    at.cell = frame.CellAt(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row));
    at.next_column = right ? 1 : -1;
    at.next_row = up ? static_cast<std::int32_t>(frame.Stride()) : -static_cast<std::int32_t>(frame.Stride());
    at.to_column = (to_low_x + (column + (right ? 1 : 0)) * frame.side.x) * inverse_.x;
    at.to_row = (to_low_y + (row + (up ? 1 : 0)) * frame.side.y) * inverse_.y;
    at.column_length = frame.side.x * std::abs(inverse_.x);
    at.row_length = frame.side.y * std::abs(inverse_.y);
    return true;
  }

  static HWY_INLINE void Step(GridPlace& at) {
    const bool by_column = at.to_column <= at.to_row;
    at.cell += static_cast<std::uint32_t>(by_column ? at.next_column : at.next_row);
    at.to_column += by_column ? at.column_length : 0;
    at.to_row += by_column ? 0 : at.row_length;
  }

  // To the last of so many cells, all empty, and no column or row further; returns where the ray leaves them.
  HWY_INLINE double Skip(std::uint32_t count, GridPlace& at) const {
    const double column = at.to_column + count * at.column_length, row = at.to_row + count * at.row_length;
    const double leave = std::min(column, row);
    // Of those crossed on the other axis.
    const bool by_column = column <= row;
    double& to = by_column ? at.to_row : at.to_column;
    const double length = by_column ? at.row_length : at.column_length;
    const double crossed = to < leave ? std::min(std::ceil((leave - to) / length), static_cast<double>(count)) : 0;
    to += crossed * length;
    (by_column ? at.to_column : at.to_row) = leave;
    const auto along = static_cast<std::int32_t>(count), aside = static_cast<std::int32_t>(crossed);
    at.cell += static_cast<std::uint32_t>(by_column ? along * at.next_column + aside * at.next_row
                                                    : along * at.next_row + aside * at.next_column);
    return leave;
  }

  Point2 origin_;
  Vector2 direction_;
  Vector2 inverse_;
};

}  // namespace HWY_NAMESPACE
}  // namespace flatlight
HWY_AFTER_NAMESPACE();

#endif  // include guard, once for every vector unit
