// SPDX-License-Identifier: Apache-2.0
#include "core/plane/walls.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "core/math/trig.h"
#include "core/plane/intersect.h"
#include "core/scene/element_frame.h"

namespace flatlight {

bool GoesOn(const Element& before, const Element& after) {
  if (before.curve != after.curve || !(before.b == after.a)) return false;
  const Vector2 end = FrameAt(before, 1).tangent, begin = FrameAt(after, 0).tangent;
  return Dot(end, begin) > 0 && std::abs(Cross(end, begin)) <= kSameDirection;
}

Walls::Walls(const Scene& scene) : scene_(scene), near_(2 * scene.touch_distance()), on_(scene.elements().size()) {
  std::vector<Box> boxes;
  double width = 0, height = 0;
  for (const Element& element : scene.elements()) {
    boxes.push_back(BoxOf(element, near_));
    width += boxes.back().high.x - boxes.back().low.x;
    height += boxes.back().high.y - boxes.back().low.y;
  }
  // Swept along the axis along which elements are short.
  if (width < height) {
    Sweep(
        boxes, [](Point2 p) { return p.x; }, [](Point2 p) { return p.y; });
  } else {
    Sweep(
        boxes, [](Point2 p) { return p.y; }, [](Point2 p) { return p.x; });
  }
  for (std::vector<Wall>& walls : on_)
    std::sort(walls.begin(), walls.end(),
              [](const Wall& a, const Wall& b) { return a.at < b.at || (a.at == b.at && a.other < b.other); });
}

template <typename Along, typename Across>
void Walls::Sweep(const std::vector<Box>& boxes, Along along, Across across) {
  std::vector<std::uint32_t> order(boxes.size()), open;
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    const double a = along(boxes[i].low), b = along(boxes[j].low);
    return a < b || (a == b && i < j);
  });
  for (const std::uint32_t i : order) {
    const Box& box = boxes[i];
    std::size_t kept = 0;
    for (const std::uint32_t j : open) {
      if (along(boxes[j].high) < along(box.low)) continue;
      open[kept++] = j;
      if (across(boxes[j].low) <= across(box.high) && across(box.low) <= across(boxes[j].high)) Meet(i, j);
    }
    open.resize(kept);
    open.push_back(i);
  }
}

void Walls::Meet(std::uint32_t i, std::uint32_t j) {
  const Element &e = scene_.elements()[i], &f = scene_.elements()[j];
  if (e.carrier == f.carrier || GoesOn(e, f) || GoesOn(f, e)) return;
  const auto add = [&](Point2 p) {
    on_[i].push_back({FractionAt(e, p) * e.length, static_cast<ElementId>(j)});
    on_[j].push_back({FractionAt(f, p) * f.length, static_cast<ElementId>(i)});
  };
  for (const Point2 p : {f.a, f.b})
    if (DistanceTo(e, p) <= near_) add(p);
  for (const Point2 p : {e.a, e.b})
    if (DistanceTo(f, p) <= near_) add(p);
  const ElementCrossings crossings = CrossElements(e, f, scene_.touch_distance());
  for (int c = 0; c < crossings.count; ++c) add(crossings.point[c]);
}

}  // namespace flatlight
