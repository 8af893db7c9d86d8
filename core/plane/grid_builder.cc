// SPDX-License-Identifier: Apache-2.0
#include "core/plane/grid_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "core/plane/grid_cover.h"

namespace flatlight {
namespace {

// So many elements pass through a cell on average, if memory allows.
constexpr double kWanted = 6;
// So many copies of each element there may be on average, and in grids in grids.
constexpr double kMostCopies = 4;
constexpr double kMostCopiesInside = 2;
// A cell of more gets a grid of its own.
constexpr std::size_t kCrowd = 32;
// Up to so many elements are looked at one and all.
constexpr double kFew = 16;
// Copies of elements in all grids, an element: beyond, no grids are made in grids.
constexpr std::size_t kMostInAll = 8;
// Elements are in all cells that they come so near to, in sides of cells.
constexpr double kMargin = 0x1p-8;
constexpr double kLeastSide = 0x1p-30;

// What a grid is to hold.
struct Contents {
  Box box;
  double length = 0;  // Of all elements.
  double count = 0;
};

// The frame of a grid of square cells over a box.
GridFrame FrameFor(const Contents& contents, double most_copies, double touch) {
  const double n = contents.count, area_floor = 8 * touch + kLeastSide;
  const double width = std::max(contents.box.high.x - contents.box.low.x, area_floor);
  const double height = std::max(contents.box.high.y - contents.box.low.y, area_floor);
  // Through a cell of side s pass n (s^2 + 4/pi s length/n) / area elements (Santalo 1976).
  const double crossing = 4 / std::numbers::pi * contents.length;
  double side = (std::sqrt(crossing * crossing + 4 * n * kWanted * width * height) - crossing) / (2 * n);
  side = std::max({side, crossing / ((most_copies - 1) * n), kLeastSide, 64 * touch});
  if (n <= kFew) side = 2 * std::max(width, height);
  // No more cells than elements, or nearly, be the box as thin as it may.
  while ((width / side + 1) * (height / side + 1) > 2 * n + 16) side *= 1.1;
  const double margin = kMargin * side + 2 * touch;
  GridFrame frame;
  frame.side = side;
  frame.inverse_side = 1 / side;
  const auto cells = [&](double extent) { return static_cast<std::uint32_t>(std::ceil((extent + 2 * margin) / side)); };
  frame.columns = cells(width);
  frame.rows = cells(height);
  const Point2 middle = contents.box.low + 0.5 * (contents.box.high - contents.box.low);
  frame.low = {middle.x - 0.5 * frame.columns * side, middle.y - 0.5 * frame.rows * side};
  return frame;
}

}  // namespace

void GridBuilder::Build() {
  const std::vector<Element>& elements = scene_.elements();
  Contents contents;
  contents.count = static_cast<double>(elements.size());
  std::vector<std::uint32_t> all(elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    all[i] = static_cast<std::uint32_t>(i);
    contents.box.Add(BoxOf(elements[i], 2 * touch_));
    contents.length += elements[i].length;
  }
  grid_.frames_.emplace_back();
  BuildGrid(0, FrameFor(contents, kMostCopies, touch_), all, 1);
}

void GridBuilder::BuildGrid(std::uint32_t index, GridFrame frame, Elements elements, std::size_t level) {
  const std::uint32_t cells = frame.CellCount();
  frame.first_cell = static_cast<std::uint32_t>(grid_.cells_.size());
  grid_.frames_[index] = frame;
  grid_.cells_.resize(grid_.cells_.size() + cells);
  const double margin = MarginOf(frame);
  grid_.least_margin_ = std::min(grid_.least_margin_, margin);
  // The elements of each cell: first their numbers, then themselves.
  std::vector<std::uint32_t> begin(cells + 1, 0);
  for (const std::uint32_t e : elements) {
    Cover(scene_.elements()[e], frame, margin, [&](std::uint32_t cell) { ++begin[cell - frame.first_cell]; });
  }
  std::uint32_t sum = 0;
  std::size_t blocks = 0;
  for (std::uint32_t& b : begin) {
    if (b <= kCrowd) blocks += (b + CurveBlock::kWidth - 1) / CurveBlock::kWidth;
    b = sum += b;
  }
  std::vector<std::uint32_t> members(sum);
  for (std::size_t i = elements.size(); i-- > 0;) {
    const std::uint32_t e = elements[i];
    Cover(scene_.elements()[e], frame, margin,
          [&](std::uint32_t cell) { members[--begin[cell - frame.first_cell]] = e; });
  }
  copies_ += sum;
  if (level == 1) grid_.blocks_.reserve(blocks);
  for (std::uint32_t cell = 0; cell < cells; ++cell) {
    const Elements here = Elements(members).subspan(begin[cell], begin[cell + 1] - begin[cell]);
    if (!here.empty()) FillCell(frame, frame.first_cell + cell, here, level);
  }
  MeasureEmptiness(frame);
}

void GridBuilder::FillCell(const GridFrame& frame, std::uint32_t cell, Elements elements, std::size_t level) {
  if (elements.size() > kCrowd && level < CurveGrid::kMostLevels && copies_ < kMostInAll * scene_.elements().size()) {
    const GridFrame inner = FrameInside(CellBox(frame, cell), elements);
    if (inner.columns * inner.rows >= 4) {
      const auto index = static_cast<std::uint32_t>(grid_.frames_.size());
      grid_.cells_[cell] = {index, GridCell::kGrid, 0};
      grid_.frames_.emplace_back();
      BuildGrid(index, inner, elements, level + 1);
      return;
    }
  }
  FillBlocks(elements, grid_.cells_[cell]);
}

void GridBuilder::FillBlocks(Elements elements, GridCell& cell) {
  const std::size_t count = (elements.size() + CurveBlock::kWidth - 1) / CurveBlock::kWidth;
  // In the place of those before it if they suffice.
  if (cell.kind > GridCell::kCurves || cell.count < count) {
    cell.first = static_cast<std::uint32_t>(grid_.blocks_.size());
    grid_.blocks_.resize(grid_.blocks_.size() + count);
  }
  cell.kind = GridCell::kSegments;
  cell.count = static_cast<std::uint32_t>(count) & GridCell::kMostCount;
  for (std::size_t i = 0; i < count * CurveBlock::kWidth; ++i) {
    CurveBlock& block = grid_.blocks_[cell.first + i / CurveBlock::kWidth];
    const std::size_t lane = i % CurveBlock::kWidth;
    if (i >= elements.size()) {
      block.ax[lane] = block.ay[lane] = block.bx[lane] = block.by[lane] = std::numeric_limits<double>::quiet_NaN();
      block.id[lane] = 0;
      continue;
    }
    const Element& element = scene_.elements()[elements[i]];
    block.ax[lane] = element.a.x, block.ay[lane] = element.a.y;
    block.bx[lane] = element.b.x, block.by[lane] = element.b.y;
    block.id[lane] = elements[i] | std::uint64_t{element.carrier} << 32;
    if (element.kind == Element::Kind::kArc) {
      block.id[lane] |= CurveBlock::kArc;
      cell.kind = GridCell::kCurves;
    }
  }
}

void GridBuilder::MeasureEmptiness(const GridFrame& frame) {
  GridCell* const cells = grid_.cells_.data() + frame.first_cell;
  const std::uint32_t stride = frame.Stride(), count = frame.CellCount();
  for (std::uint32_t cell = 0; cell < count; ++cell) {
    const std::uint32_t column = cell % stride, row = cell / stride;
    if (column == 0 || column + 1 == stride || row == 0 || row == frame.rows + 1) cells[cell].kind = GridCell::kOutside;
  }
  // How many columns or rows away the nearest cell is that is not empty: first of those before, then of all.
  const auto away = [&](std::uint32_t cell) {
    return cells[cell].kind == GridCell::kEmpty ? std::uint32_t{cells[cell].count} + 1 : 0;
  };
  for (std::uint32_t cell = stride; cell < count - stride; ++cell) {
    if (cells[cell].kind != GridCell::kEmpty) continue;
    cells[cell].count =
        std::min({away(cell - stride - 1), away(cell - stride), away(cell - stride + 1), away(cell - 1)}) &
        GridCell::kMostCount;
  }
  for (std::uint32_t cell = count - stride; cell-- > stride;) {
    if (cells[cell].kind != GridCell::kEmpty) continue;
    cells[cell].count = std::min({std::uint32_t{cells[cell].count}, away(cell + stride + 1), away(cell + stride),
                                  away(cell + stride - 1), away(cell + 1)}) &
                        GridCell::kMostCount;
  }
}

double GridBuilder::MarginOf(const GridFrame& frame) const { return kMargin * frame.side + 2 * touch_; }

Box GridBuilder::CellBox(const GridFrame& frame, std::uint32_t cell) const {
  const std::uint32_t column = (cell - frame.first_cell) % frame.Stride() - 1;
  const std::uint32_t row = (cell - frame.first_cell) / frame.Stride() - 1;
  const double margin = MarginOf(frame);
  const Point2 low{frame.low.x + column * frame.side - margin, frame.low.y + row * frame.side - margin};
  return {low, low + (frame.side + 2 * margin) * Vector2{1, 1}};
}

GridFrame GridBuilder::FrameInside(const Box& cell, Elements elements) const {
  Contents contents;
  for (const std::uint32_t e : elements) {
    const Element& element = scene_.elements()[e];
    const Box box = ClippedBox(element, cell, 2 * touch_);
    if (box.low.x > box.high.x || box.low.y > box.high.y) continue;
    contents.box.Add(box);
    contents.length += std::min(element.length, Length(box.high - box.low));
    contents.count += 1;
  }
  return contents.count == 0 ? GridFrame{} : FrameFor(contents, kMostCopiesInside, touch_);
}

}  // namespace flatlight
