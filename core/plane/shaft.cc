// SPDX-License-Identifier: Apache-2.0
#include "core/plane/shaft.h"

#include <algorithm>
#include <cmath>

#include "core/math/tolerances.h"

namespace flatlight {
namespace {

// Rays take a piece for hit up to one touch distance away; beyond that this is far above rounding.
constexpr double kMarginTouches = 4;
// A point that touches another curve is looked at from beside it: what hides it hides the places nearby too.
constexpr double kHidingMargin = 2 * kFarthestOnward;
// So many pieces in the way are enough to give up.
constexpr int kMostInTheWay = 16;
// Far above the rounding of a squared distance.
constexpr double kInsideMargin = 1e-9;

// A convex polygon, counter-clockwise.
class Polygon {
 public:
  Polygon(const Corners& from, const Corners& to) {
    std::array<Point2, 8> sorted;
    std::size_t count = 0;
    for (const Corners* corners : {&from, &to}) {
      for (std::size_t i = 0; i < corners->count; ++i) {
        const Point2 p = corners->point[i];
        std::size_t place = count++;
        for (; place > 0 && Before(p, sorted[place - 1]); --place) sorted[place] = sorted[place - 1];
        sorted[place] = p;
      }
    }
    // The monotone chain (Andrew 1979): the lower side, then the upper one.
    const auto add = [&](Point2 p, std::size_t begin) {
      while (count_ >= begin + 2 && !(Cross(point_[count_ - 1] - point_[count_ - 2], p - point_[count_ - 1]) > 0))
        --count_;
      if (count_ == 0 || !(point_[count_ - 1] == p)) point_[count_++] = p;
    };
    for (std::size_t i = 0; i < count; ++i) add(sorted[i], 0);
    const std::size_t upper = count_ - 1;
    for (std::size_t i = count - 1; i-- > 0;) add(sorted[i], upper);
    if (count_ > 1 && point_[count_ - 1] == point_[0]) --count_;
    for (std::size_t i = 0; i < count_; ++i) {
      box_.Add(point_[i]);
      edge_[i] = point_[(i + 1) % count_] - point_[i];
      length_[i] = Length(edge_[i]);
    }
  }

  static bool Before(Point2 p, Point2 q) { return p.x < q.x || (p.x == q.x && p.y < q.y); }

  bool IsFlat() const { return count_ < 3; }

  // Whether nothing in the box comes as near as the margin.
  bool Misses(const Box& box, double margin) const {
    if (box.low.x > box_.high.x + margin || box.high.x < box_.low.x - margin || box.low.y > box_.high.y + margin ||
        box.high.y < box_.low.y - margin) {
      return true;
    }
    for (std::size_t i = 0; i < count_; ++i) {
      // The corner of the box that is farthest to the inner, left side of the edge.
      const Vector2 e = edge_[i];
      const Point2 inner{e.y > 0 ? box.low.x : box.high.x, e.x > 0 ? box.high.y : box.low.y};
      if (Cross(e, inner - point_[i]) < -margin * length_[i]) return true;
    }
    return false;
  }

  // Whether the convex hull of the corners has nothing but corners or an edge in common with this.
  bool Misses(const Corners& corners, double margin) const {
    for (std::size_t i = 0; i < count_; ++i) {
      const Point2 p = point_[i];
      const Point2 q = point_[(i + 1) % count_];
      bool outside = true;
      for (std::size_t k = 0; k < corners.count && outside; ++k) {
        const Point2 c = corners.point[k];
        outside = c == p || c == q || Cross(edge_[i], c - p) < -margin * length_[i];
      }
      if (outside) return true;
    }
    for (std::size_t k = 0; k < corners.count; ++k) {
      const Point2 p = corners.point[k];
      const Point2 q = corners.point[(k + 1) % corners.count];
      const Vector2 edge = q - p;
      const double doubt = margin * Length(edge);
      // On the other side of this edge than the rest of the piece, if it has more.
      double inner = 0;
      if (corners.count > 2) inner = Cross(edge, corners.point[(k + 2) % corners.count] - p);
      bool left = true;
      bool right = true;
      for (std::size_t i = 0; i < count_ && (left || right); ++i) {
        if (point_[i] == p || point_[i] == q) continue;
        const double side = Cross(edge, point_[i] - p);
        left = left && side > doubt;
        right = right && side < -doubt;
      }
      if ((left && inner <= 0) || (right && inner >= 0)) return true;
    }
    return false;
  }

 private:
  std::array<Point2, 9> point_;
  std::array<Vector2, 9> edge_;
  std::array<double, 9> length_;
  std::size_t count_ = 0;
  Box box_;
};

// Whether every line from one set to the other crosses the segment: its line parts the sets, and the lines between
// their corners cross it. Seen from any point of one set, the other's shadow on the line ends at shadows of corners.
bool Hides(const Element& segment, const Corners& from, const Corners& to, double margin) {
  const Vector2 along = segment.b - segment.a;
  const double doubt = margin * segment.length;
  std::array<double, 4> from_side;
  std::array<double, 4> to_side;
  for (std::size_t i = 0; i < from.count; ++i) from_side[i] = Cross(along, from.point[i] - segment.a);
  for (std::size_t i = 0; i < to.count; ++i) to_side[i] = Cross(along, to.point[i] - segment.a);
  const double turn = from_side[0] > 0 ? 1 : -1;
  for (std::size_t i = 0; i < from.count; ++i)
    if (!(turn * from_side[i] > doubt)) return false;
  for (std::size_t i = 0; i < to.count; ++i)
    if (!(-turn * to_side[i] > doubt)) return false;
  const double length_squared = segment.length * segment.length;
  for (std::size_t i = 0; i < from.count; ++i) {
    for (std::size_t k = 0; k < to.count; ++k) {
      const double share = from_side[i] / (from_side[i] - to_side[k]);
      const Point2 crossing = from.point[i] + share * (to.point[k] - from.point[i]);
      const double place = Dot(along, crossing - segment.a);
      if (!(place > doubt && place < length_squared - doubt)) return false;
    }
  }
  return true;
}

}  // namespace

Corners CornersOf(Point2 point) {
  Corners corners;
  corners.Add(point);
  return corners;
}

Corners CornersOf(const Box& box) {
  Corners corners;
  for (const Point2 p : {box.low, Point2{box.high.x, box.low.y}, box.high, Point2{box.low.x, box.high.y}})
    corners.Add(p);
  return corners;
}

Corners CornersOf(const Element& element) {
  Corners corners;
  corners.Add(element.a);
  corners.Add(element.b);
  if (element.kind == Element::Kind::kArc) {
    const Vector2 middle = Normalized(element.radial_a + element.radial_b);
    const double half_chord = 0.5 * Length(element.b - element.a);
    const double tangent = std::abs(Cross(element.radial_a, middle)) / Dot(element.radial_a, middle);
    corners.Add(element.a + 0.5 * (element.b - element.a) + (half_chord * tangent) * middle);
  }
  return corners;
}

bool CircleHolds(const Element& arc, const Corners& corners) {
  for (std::size_t i = 0; i < corners.count; ++i) {
    if (!(LengthSquared(corners.point[i] - arc.center) < (1 - kInsideMargin) * arc.radius * arc.radius)) return false;
  }
  return true;
}

Passage PassageBetween(const Scene& scene, const Bvh& bvh, const Corners& from, const Corners& to,
                       const OwnCarriers& own) {
  const Polygon shaft(from, to);
  if (shaft.IsFlat() || bvh.nodes().empty()) return Passage::kUncertain;
  const double margin = kMarginTouches * scene.touch_distance();
  int in_the_way = 0;
  struct Entry {
    std::uint32_t node;
    std::uint32_t frame;
  };
  std::array<Entry, std::size_t{BvhNode::kWidth} * (Bvh::kMaxDepth + 1)> stack;
  std::size_t size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const Entry entry = stack[--size];
    const BvhNode& node = bvh.nodes()[entry.node];
    if (node.kind == BvhNode::Kind::kFrame) {
      stack[size++] = {node.first, node.frame};
      continue;
    }
    const BvhFrame& frame = bvh.frames()[entry.frame];
    for (int lane = 0; lane < node.count; ++lane) {
      const std::uint32_t place = node.first + static_cast<std::uint32_t>(lane);
      if (node.kind != BvhNode::Kind::kEnds) {
        if (shaft.Misses(frame.ToScene(node.BoxOfLane(lane)), margin)) continue;
      }
      if (node.kind == BvhNode::Kind::kInner) {
        stack[size++] = {place, entry.frame};
        continue;
      }
      const Bvh::Slot& slot = bvh.slots()[place];
      if (slot.carrier == own.from || slot.carrier == own.to) continue;
      const Element& element = scene.elements()[slot.element];
      if (shaft.Misses(CornersOf(element), margin)) continue;
      if (element.kind == Element::Kind::kSegment && Hides(element, from, to, kHidingMargin)) return Passage::kHidden;
      if (++in_the_way == kMostInTheWay) return Passage::kUncertain;
    }
  }
  return in_the_way == 0 ? Passage::kClear : Passage::kUncertain;
}

}  // namespace flatlight
