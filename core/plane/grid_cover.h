// SPDX-License-Identifier: Apache-2.0
// Which cells of a grid an element passes through.
#ifndef FLATLIGHT_CORE_PLANE_GRID_COVER_H_
#define FLATLIGHT_CORE_PLANE_GRID_COVER_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/math/tolerances.h"
#include "core/math/vec.h"
#include "core/plane/box.h"
#include "core/plane/curve_grid.h"
#include "core/scene/scene.h"

namespace flatlight {

// The part of a segment in a horizontal stripe, as an interval of x; low is above high if there is none.
struct Stretch {
  double low;
  double high;
};
inline Stretch StretchBetween(Point2 a, Point2 b, double low, double high) {
  if (a.y > b.y) std::swap(a, b);
  if (b.y < low || a.y > high) return {1, -1};
  const double slope = (b.x - a.x) / (b.y - a.y);
  const double x0 = a.y < low ? a.x + (low - a.y) * slope : a.x;
  const double x1 = b.y > high ? a.x + (high - a.y) * slope : b.x;
  return {std::min(x0, x1), std::max(x0, x1)};
}

// Calls visit(cell) for every cell that comes as near to the element as the margin.
template <typename Visit>
void Cover(const Element& element, const GridFrame& frame, double margin, const Visit& visit) {
  const bool straight = element.kind == Element::Kind::kSegment;
  Box box;
  if (straight) {
    box.Add(element.a);
    box.Add(element.b);
  } else {
    box = BoxOf(element, 0);
  }
  const auto number = [](double offset, std::uint32_t count) {
    return static_cast<std::uint32_t>(std::clamp(offset, 0.0, static_cast<double>(count - 1)));
  };
  const auto column_at = [&](double x) { return number((x - frame.low.x) * frame.inverse_side.x, frame.columns); };
  const auto row_at = [&](double y) { return number((y - frame.low.y) * frame.inverse_side.y, frame.rows); };
  // Of a grid over a part of the scene only what lies in it.
  const double right = frame.low.x + frame.columns * frame.side.x, top = frame.low.y + frame.rows * frame.side.y;
  if (box.high.x + margin < frame.low.x || box.low.x - margin > right || box.high.y + margin < frame.low.y ||
      box.low.y - margin > top) {
    return;
  }
  const std::uint32_t first_row = row_at(box.low.y - margin), last_row = row_at(box.high.y + margin);
  if (straight && first_row == last_row) {
    Stretch part{box.low.x, box.high.x};
    if (box.low.y < frame.low.y - margin || box.high.y > top + margin) {
      part = StretchBetween(element.a, element.b, frame.low.y - margin, top + margin);
      if (part.low > part.high || part.high + margin < frame.low.x || part.low - margin > right) return;
    }
    const std::uint32_t last = column_at(part.high + margin);
    for (std::uint32_t column = column_at(part.low - margin); column <= last; ++column)
      visit(frame.CellAt(column, first_row));
    return;
  }
  for (std::uint32_t row = first_row; row <= last_row; ++row) {
    const double low = frame.low.y + row * frame.side.y - margin, high = low + frame.side.y + 2 * margin;
    if (straight) {
      const Stretch part = StretchBetween(element.a, element.b, low, high);
      if (part.low > part.high || part.high + margin < frame.low.x || part.low - margin > right) continue;
      const std::uint32_t last = column_at(part.high + margin);
      for (std::uint32_t column = column_at(part.low - margin); column <= last; ++column)
        visit(frame.CellAt(column, row));
      continue;
    }
    const double doubt = margin + 16 * kUnitRoundoff * element.radius;
    const double least = element.radius - doubt, most = element.radius + doubt;
    const double y0 = low - element.center.y, y1 = high - element.center.y;
    const double far_y = std::max(std::abs(y0), std::abs(y1)), near_y = y0 > 0 ? y0 : y1 < 0 ? -y1 : 0;
    const std::uint32_t last = column_at(box.high.x + margin);
    for (std::uint32_t column = column_at(box.low.x - margin); column <= last; ++column) {
      const double x0 = frame.low.x + column * frame.side.x - margin - element.center.x;
      const double x1 = x0 + frame.side.x + 2 * margin;
      const double far_x = std::max(std::abs(x0), std::abs(x1)), near_x = x0 > 0 ? x0 : x1 < 0 ? -x1 : 0;
      const bool beyond = near_x * near_x + near_y * near_y > most * most;
      const bool within = least > 0 && far_x * far_x + far_y * far_y < least * least;
      if (!beyond && !within) visit(frame.CellAt(column, row));
    }
  }
}

// Encloses what of the element lies in the box, with a margin.
inline Box ClippedBox(const Element& element, const Box& cell, double margin) {
  Box box = BoxOf(element, margin);
  if (element.kind == Element::Kind::kSegment) {
    const Stretch x = StretchBetween(element.a, element.b, cell.low.y, cell.high.y);
    const Stretch y = StretchBetween({element.a.y, element.a.x}, {element.b.y, element.b.x}, cell.low.x, cell.high.x);
    if (x.low > x.high || y.low > y.high) return {};
    box = {{x.low - margin, y.low - margin}, {x.high + margin, y.high + margin}};
  }
  return {{std::max(box.low.x, cell.low.x), std::max(box.low.y, cell.low.y)},
          {std::min(box.high.x, cell.high.x), std::min(box.high.y, cell.high.y)}};
}

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_GRID_COVER_H_
