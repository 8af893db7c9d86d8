// SPDX-License-Identifier: Apache-2.0
// A grid over the elements of a scene, for rays: a ray's cell is known without a search, and it walks from cell to cell
// (Amanatides and Woo 1987). Every cell has a copy of the elements that pass through it, in lanes for vector code.
// Where curves crowd, a cell has a grid of its own, over nothing but them (Jevans and Wyvill 1989), and empty cells say
// how far around there is nothing (Cohen and Sheffer 1994).
#ifndef FLATLIGHT_CORE_PLANE_CURVE_GRID_H_
#define FLATLIGHT_CORE_PLANE_CURVE_GRID_H_

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/math/vec.h"
#include "core/scene/scene.h"

namespace flatlight {

// Elements in lanes; the ends of arcs are those of their chords. Lanes that are not in use hold NaN.
struct alignas(64) CurveBlock {
  static constexpr std::uint32_t kWidth = 8;
  static constexpr std::uint64_t kArc = std::uint64_t{1} << 63;

  double ax[kWidth];
  double ay[kWidth];
  double bx[kWidth];
  double by[kWidth];
  std::uint64_t id[kWidth];  // Element, carrier << 32, and kArc if it is one.

  std::uint32_t element(std::uint32_t lane) const { return static_cast<std::uint32_t>(id[lane]); }
  std::uint32_t carrier(std::uint32_t lane) const { return static_cast<std::uint32_t>((id[lane] & ~kArc) >> 32); }
  bool InUse(std::uint32_t lane) const { return ax[lane] == ax[lane]; }
};
static_assert(sizeof(CurveBlock) == 320);

struct GridCell {
  enum Kind : std::uint32_t {
    kSegments,  // `count` blocks from `first` on, of segments alone.
    kCurves,    // The same, with arcs among them.
    kGrid,      // Grid `first` is over all that passes through.
    kEmpty,     // All cells up to `count` columns and rows away are empty too.
    kOutside,   // Around the grid, the cells next to it.
  };
  std::uint32_t first = 0;
  std::uint32_t kind : 3 = kEmpty;
  std::uint32_t count : 29 = 0;

  static constexpr std::uint32_t kMostCount = (1u << 29) - 1;
};
static_assert(sizeof(GridCell) == 8);

// The place of one grid's cells.
struct GridFrame {
  Point2 low;          // The corner of the first cell that is not outside.
  Vector2 side{1, 1};  // Of a cell.
  Vector2 inverse_side{1, 1};
  std::uint32_t columns = 0;  // Without those outside.
  std::uint32_t rows = 0;
  std::uint32_t first_cell = 0;

  std::uint32_t Stride() const { return columns + 2; }
  std::uint32_t CellCount() const { return (columns + 2) * (rows + 2); }
  std::uint32_t CellAt(std::uint32_t column, std::uint32_t row) const {
    return first_cell + (row + 1) * Stride() + column + 1;
  }
};

class CurveGrid {
 public:
  static constexpr std::size_t kMostLevels = 10;  // Of grids in grids.

  explicit CurveGrid(const Scene& scene);

  // The grid of a scene that differs little from the one this was made for: only what changed is done again. Absent if
  // too much changed, or out of the grid: then build a new one.
  std::optional<CurveGrid> Refit(const Scene& before, const Scene& after) const;

  // Frame 0 is that of the scene's grid. Empty if there are no elements.
  const std::vector<GridFrame>& frames() const { return frames_; }
  const std::vector<GridCell>& cells() const { return cells_; }
  const std::vector<CurveBlock>& blocks() const { return blocks_; }
  // Rays that begin farther than this from the origin may round to other cells than those they pass through.
  double reach() const { return reach_; }

 private:
  friend class GridBuilder;

  std::vector<GridFrame> frames_;
  std::vector<GridCell> cells_;
  std::vector<CurveBlock> blocks_;
  double reach_ = std::numeric_limits<double>::infinity();
  std::size_t built_size_ = 0;  // Cells and blocks when it was built.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_CURVE_GRID_H_
