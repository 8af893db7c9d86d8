// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_GRID_BUILDER_H_
#define FLATLIGHT_CORE_PLANE_GRID_BUILDER_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/plane/box.h"
#include "core/plane/curve_grid.h"
#include "core/scene/scene.h"

namespace flatlight {

// Builds the grid of a scene, and brings the grid of another scene up to this one.
class GridBuilder {
 public:
  GridBuilder(const Scene& scene, CurveGrid& grid) : scene_(scene), grid_(grid), touch_(scene.touch_distance()) {}

  // Requires an empty grid, and elements.
  void Build();

  // Makes the grid of `before` that of the scene, where only these elements are other ones; false if it is too small.
  bool Update(const Scene& before, std::span<const std::uint32_t> changed);

 private:
  // Numbers of elements in rising order.
  using Elements = std::span<const std::uint32_t>;
  // An element in a cell.
  struct Member {
    std::uint32_t cell;
    std::uint32_t element;
    friend bool operator<(const Member& l, const Member& r) {
      return l.cell != r.cell ? l.cell < r.cell : l.element < r.element;
    }
  };

  void BuildGrid(std::uint32_t index, GridFrame frame, Elements elements, std::size_t level);
  // A cell that elements pass through: in blocks, or in a grid of its own.
  void FillCell(const GridFrame& frame, std::uint32_t cell, Elements elements, std::size_t level);
  void FillBlocks(Elements elements, GridCell& cell);
  // Says of empty cells how far around there is nothing.
  void MeasureEmptiness(const GridFrame& frame);

  void UpdateGrid(const Scene& before, std::uint32_t index, Elements changed, std::size_t level);
  void UpdateCell(const Scene& before, const GridFrame& frame, std::uint32_t cell, Elements gone, Elements come,
                  std::size_t level);
  void AddElementsIn(const GridCell& cell, std::vector<std::uint32_t>& elements) const;

  double MarginOf(const GridFrame& frame) const;
  Box CellBox(const GridFrame& frame, std::uint32_t cell) const;
  GridFrame FrameInside(const Box& cell, Elements elements) const;

  const Scene& scene_;
  CurveGrid& grid_;
  const double touch_;
  std::size_t copies_ = 0;  // Of elements, in all grids.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_GRID_BUILDER_H_
