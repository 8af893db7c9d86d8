// SPDX-License-Identifier: Apache-2.0
// The grid of an edited scene.
#include <algorithm>
#include <iterator>
#include <vector>

#include "core/plane/grid_builder.h"
#include "core/plane/grid_cover.h"

namespace flatlight {
namespace {

bool Encloses(const GridFrame& frame, const Box& box) {
  return frame.low.x <= box.low.x && frame.low.y <= box.low.y &&
         frame.low.x + frame.columns * frame.side.x >= box.high.x &&
         frame.low.y + frame.rows * frame.side.y >= box.high.y;
}

}  // namespace

bool GridBuilder::Update(const Scene& before, Elements changed) {
  for (const std::uint32_t e : changed) {
    if (!Encloses(grid_.frames_[0], BoxOf(scene_.elements()[e], 2 * touch_))) return false;
  }
  UpdateGrid(before, 0, changed, 1);
  return true;
}

void GridBuilder::UpdateGrid(const Scene& before, std::uint32_t index, Elements changed, std::size_t level) {
  const GridFrame frame = grid_.frames_[index];
  const double margin = MarginOf(frame);
  std::vector<Member> gone, come;
  for (const std::uint32_t e : changed) {
    Cover(before.elements()[e], frame, margin, [&](std::uint32_t cell) { gone.push_back({cell, e}); });
    Cover(scene_.elements()[e], frame, margin, [&](std::uint32_t cell) { come.push_back({cell, e}); });
  }
  std::sort(gone.begin(), gone.end());
  std::sort(come.begin(), come.end());
  std::vector<std::uint32_t> gone_here, come_here;
  for (auto g = gone.begin(), c = come.begin(); g != gone.end() || c != come.end();) {
    const std::uint32_t cell = c == come.end() || (g != gone.end() && g->cell < c->cell) ? g->cell : c->cell;
    gone_here.clear(), come_here.clear();
    for (; g != gone.end() && g->cell == cell; ++g) gone_here.push_back(g->element);
    for (; c != come.end() && c->cell == cell; ++c) come_here.push_back(c->element);
    UpdateCell(before, frame, cell, gone_here, come_here, level);
  }
  MeasureEmptiness(frame);
}

void GridBuilder::UpdateCell(const Scene& before, const GridFrame& frame, std::uint32_t cell, Elements gone,
                             Elements come, std::size_t level) {
  const GridCell here = grid_.cells_[cell];
  if (here.kind == GridCell::kGrid) {
    const GridFrame& inner = grid_.frames_[here.first];
    const bool fits = std::all_of(come.begin(), come.end(), [&](std::uint32_t e) {
      return Encloses(inner, ClippedBox(scene_.elements()[e], CellBox(frame, cell), 2 * touch_));
    });
    if (fits) {
      std::vector<std::uint32_t> changed;
      std::set_union(gone.begin(), gone.end(), come.begin(), come.end(), std::back_inserter(changed));
      return UpdateGrid(before, here.first, changed, level + 1);
    }
  }
  std::vector<std::uint32_t> all, kept, elements;
  AddElementsIn(here, all);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::set_difference(all.begin(), all.end(), gone.begin(), gone.end(), std::back_inserter(kept));
  std::set_union(kept.begin(), kept.end(), come.begin(), come.end(), std::back_inserter(elements));
  if (elements.empty()) {
    grid_.cells_[cell] = {};
  } else {
    FillCell(frame, cell, elements, level);
  }
}

void GridBuilder::AddElementsIn(const GridCell& cell, std::vector<std::uint32_t>& elements) const {
  if (cell.kind == GridCell::kGrid) {
    const GridFrame& frame = grid_.frames_[cell.first];
    for (std::uint32_t i = 0; i < frame.CellCount(); ++i) AddElementsIn(grid_.cells_[frame.first_cell + i], elements);
  } else if (cell.kind <= GridCell::kCurves) {
    for (std::uint32_t i = cell.first; i < cell.first + cell.count; ++i)
      for (std::uint32_t lane = 0; lane < CurveBlock::kWidth; ++lane)
        if (grid_.blocks_[i].InUse(lane)) elements.push_back(grid_.blocks_[i].element(lane));
  }
}

}  // namespace flatlight
