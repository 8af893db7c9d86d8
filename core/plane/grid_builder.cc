// SPDX-License-Identifier: Apache-2.0
#include "core/plane/grid_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "core/math/tolerances.h"
#include "core/plane/grid_cover.h"

namespace flatlight {
namespace {

// So many elements pass through a cell on average, if memory allows.
constexpr double kWanted = 6;
// So many copies of each element there may be on average, and in grids in grids.
constexpr double kMostCopies = 4;
constexpr double kMostCopiesInside = 2;
// Or so many in all, if that is more, but not more than so many of each.
constexpr double kAlwaysCopies = 0x1p18;
constexpr double kAlwaysCopiesOfEach = 16;
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
  Vector2 extent{0, 0};  // Of all elements, added up.
  double length = 0;     // Of all elements.
  double count = 0;

  void Add(const Box& element, double element_length) {
    box.Add(element);
    extent = extent + (element.high - element.low);
    length += std::min(element_length, Length(element.high - element.low));
    count += 1;
  }
};

double MarginFor(Vector2 side, double touch) { return kMargin * std::min(side.x, side.y) + 2 * touch; }

// The side of square cells.
double SquareSide(const Contents& contents, Vector2 size, double most_copies) {
  // Through a cell of side s pass n (s^2 + 4/pi s length/n) / area elements (Santalo 1976).
  const double n = contents.count, crossing = 4 / std::numbers::pi * contents.length;
  const double side = (std::sqrt(crossing * crossing + 4 * n * kWanted * size.x * size.y) - crossing) / (2 * n);
  return std::max(side, crossing / ((most_copies - 1) * n));
}

// The height of cells as wide as the grid, where all elements together are `extent` high.
double StripeHeight(double n, double extent, double height, double most_copies) {
  return std::max((kWanted * height - extent) / n, extent / ((most_copies - 1) * n));
}

// What a ray costs among cells of these sides, in elements met.
double Cost(const Contents& contents, Vector2 size, Vector2 side) {
  constexpr double kStep = 8;  // From cell to cell.
  const double area = size.x * size.y, n = contents.count;
  // The mean free path (Santalo), and what passes through a cell.
  const double path = std::min(0.5 * std::numbers::pi * area / contents.length, size.x + size.y);
  const double along_x = side.x < size.x ? contents.extent.x / side.x : 0;
  const double along_y = side.y < size.y ? contents.extent.y / side.y : 0;
  const double cell = std::min(side.x, size.x) * std::min(side.y, size.y);
  return (1 + path / side.x + path / side.y) * (kStep + (n + along_x + along_y) * cell / area);
}

// Square cells, or where curves are parallel to an axis, stripes along them if they are worth it.
Vector2 SidesFor(const Contents& contents, Vector2 size, double most_copies) {
  constexpr double kWorth = 0.5;
  const double n = contents.count, square = SquareSide(contents, size, most_copies);
  const double wide = 1.25 * size.x, high = 1.25 * size.y;  // With room for margins.
  Vector2 best{square, square};
  double least = kWorth * Cost(contents, size, best);
  for (const Vector2 sides : {Vector2{wide, StripeHeight(n, contents.extent.y, size.y, most_copies)},
                              Vector2{StripeHeight(n, contents.extent.x, size.x, most_copies), high}}) {
    const double cost = Cost(contents, size, sides);
    if (cost < least) best = sides, least = cost;
  }
  return best;
}

// The frame of a grid over a box.
GridFrame FrameFor(const Contents& contents, double most_copies, double touch) {
  const double n = contents.count, floor = kLeastSide + 64 * touch;
  const Vector2 box = contents.box.high - contents.box.low, size{std::max(box.x, floor), std::max(box.y, floor)};
  Vector2 side{2 * std::max(size.x, size.y), 2 * std::max(size.x, size.y)};
  if (n > kFew) side = SidesFor(contents, size, most_copies);
  side = {std::max(side.x, floor), std::max(side.y, floor)};
  // No more cells than elements, or nearly, be the box as thin as it may.
  while ((size.x / side.x + 1) * (size.y / side.y + 1) > 2 * n + 16) side = 1.1 * side;
  const double margin = MarginFor(side, touch);
  GridFrame frame;
  frame.side = side;
  frame.inverse_side = {1 / side.x, 1 / side.y};
  frame.columns = static_cast<std::uint32_t>(std::ceil((size.x + 2 * margin) * frame.inverse_side.x));
  frame.rows = static_cast<std::uint32_t>(std::ceil((size.y + 2 * margin) * frame.inverse_side.y));
  const Point2 middle = contents.box.low + 0.5 * box;
  frame.low = {middle.x - 0.5 * frame.columns * side.x, middle.y - 0.5 * frame.rows * side.y};
  return frame;
}

}  // namespace

void GridBuilder::Build() {
  const std::vector<Element>& elements = scene_.elements();
  Contents contents;
  std::vector<std::uint32_t> all(elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    all[i] = static_cast<std::uint32_t>(i);
    contents.Add(BoxOf(elements[i], 2 * touch_), elements[i].length);
  }
  grid_.frames_.emplace_back();
  BuildGrid(0, FrameFor(contents, std::clamp(kAlwaysCopies / contents.count, kMostCopies, kAlwaysCopiesOfEach), touch_),
            all, 1);
}

void GridBuilder::BuildGrid(std::uint32_t index, GridFrame frame, Elements elements, std::size_t level) {
  const std::uint32_t cells = frame.CellCount();
  frame.first_cell = static_cast<std::uint32_t>(grid_.cells_.size());
  grid_.frames_[index] = frame;
  grid_.cells_.resize(grid_.cells_.size() + cells);
  const double margin = MarginOf(frame);
  // Rounding adds up from cell to cell.
  const double steps = frame.columns + frame.rows;
  grid_.reach_ = std::min(grid_.reach_, margin / (kUnitRoundoff * (64 + steps)));
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

double GridBuilder::MarginOf(const GridFrame& frame) const { return MarginFor(frame.side, touch_); }

Box GridBuilder::CellBox(const GridFrame& frame, std::uint32_t cell) const {
  const std::uint32_t column = (cell - frame.first_cell) % frame.Stride() - 1;
  const std::uint32_t row = (cell - frame.first_cell) / frame.Stride() - 1;
  const double margin = MarginOf(frame);
  const Point2 low{frame.low.x + column * frame.side.x - margin, frame.low.y + row * frame.side.y - margin};
  return {low, low + frame.side + 2 * margin * Vector2{1, 1}};
}

GridFrame GridBuilder::FrameInside(const Box& cell, Elements elements) const {
  Contents contents;
  for (const std::uint32_t e : elements) {
    const Element& element = scene_.elements()[e];
    const Box box = ClippedBox(element, cell, 2 * touch_);
    if (box.low.x > box.high.x || box.low.y > box.high.y) continue;
    contents.Add(box, element.length);
  }
  return contents.count == 0 ? GridFrame{} : FrameFor(contents, kMostCopiesInside, touch_);
}

}  // namespace flatlight
