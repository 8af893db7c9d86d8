// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_BOX_H_
#define FLATLIGHT_CORE_PLANE_BOX_H_

#include <algorithm>
#include <limits>

#include "core/math/vec.h"
#include "core/scene/scene.h"

namespace flatlight {

// An axis-parallel rectangle; empty at first.
struct Box {
  Point2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Point2 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  void Add(Point2 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  void Add(const Box& box) {
    low = {std::min(low.x, box.low.x), std::min(low.y, box.low.y)};
    high = {std::max(high.x, box.high.x), std::max(high.y, box.high.y)};
  }
  double HalfPerimeter() const { return (high.x - low.x) + (high.y - low.y); }
};

// Encloses the element, with a margin to spare on all sides.
Box BoxOf(const Element& element, double margin);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_BOX_H_
