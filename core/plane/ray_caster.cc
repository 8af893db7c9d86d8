// SPDX-License-Identifier: Apache-2.0
#include "core/plane/ray_caster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/plane/intersect.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kNoCarrier = 0xffffffff;

// A ray made ready for box tests.
struct Ray {
  Point2 origin;
  Vector2 direction;
  Vector2 inverse;

  Ray(Point2 from, Vector2 along) : origin(from), direction(along), inverse{1 / along.x, 1 / along.y} {}

  // Where the ray enters the box, or infinity if it misses it or enters beyond `end`. A component of 0 makes infinities
  // and, on the box's face, NaN; the order of the comparisons lets those pass.
  double Enter(const Box& box, double end) const {
    const double x0 = (box.low.x - origin.x) * inverse.x;
    const double x1 = (box.high.x - origin.x) * inverse.x;
    const double y0 = (box.low.y - origin.y) * inverse.y;
    const double y1 = (box.high.y - origin.y) * inverse.y;
    const double enter = std::max(std::max(0.0, std::min(x0, x1)), std::min(y0, y1));
    const double leave = std::min(std::min(end, std::max(x0, x1)), std::max(y0, y1));
    // Boxes are larger than their contents by more than these products round.
    return enter <= leave * (1 + 4e-16) ? enter : kInfinity;
  }
};

// What a ray that leaves `from` meets on one element.
Crossings Cross(const Element& element, const SurfacePoint& from, std::uint32_t carrier, Vector2 direction,
                double touch) {
  if (element.kind == Element::Kind::kSegment) {
    return element.carrier == carrier ? Crossings{} : CrossSegment(element, from.position, direction, touch);
  }
  return element.carrier == carrier ? CrossOwnCircle(element, from.position, direction, touch)
                                    : CrossArc(element, from.position, direction, touch);
}

// Visits the leaves along the ray, near ones first, until `visit` answers true. `end` may shrink meanwhile.
template <typename Visit>
void Walk(const Bvh& bvh, const Ray& ray, const double& end, Visit visit) {
  if (bvh.nodes().empty()) return;
  struct Entry {
    std::uint32_t node;
    double enter;
  };
  std::array<Entry, Bvh::kMaxDepth + 2> stack;
  std::size_t size = 0;
  stack[size++] = {0, ray.Enter(bvh.nodes()[0].box, end)};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (!(entry.enter <= end)) continue;
    const Bvh::Node& node = bvh.nodes()[entry.node];
    if (node.count == 0) {
      Entry near{node.first, ray.Enter(bvh.nodes()[node.first].box, end)};
      Entry far{node.first + 1, ray.Enter(bvh.nodes()[node.first + 1].box, end)};
      if (far.enter < near.enter) std::swap(near, far);
      if (far.enter < kInfinity) stack[size++] = far;
      if (near.enter < kInfinity) stack[size++] = near;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      if (visit(bvh.order()[i])) return;
  }
}

}  // namespace

RayCaster::RayCaster(std::shared_ptr<const Scene> scene) : scene_(std::move(scene)), bvh_(*scene_) {}

std::optional<Hit> RayCaster::ClosestHit(const SurfacePoint& from, Vector2 direction) const {
  const std::uint32_t carrier = from.element == ElementId::kNone ? kNoCarrier : scene_->element(from.element).carrier;
  const Ray ray(from.position, direction);
  double nearest = kInfinity;
  std::uint32_t hit_element = 0;
  Walk(bvh_, ray, nearest, [&](std::uint32_t index) {
    const Crossings crossings = Cross(scene_->elements()[index], from, carrier, direction, scene_->touch_distance());
    for (int i = 0; i < crossings.count; ++i) {
      const double t = crossings.t[i];
      if (t > 0 && (t < nearest || (t == nearest && index < hit_element))) nearest = t, hit_element = index;
    }
    return false;
  });
  if (nearest == kInfinity) return std::nullopt;
  Hit hit{nearest, static_cast<ElementId>(hit_element), from.position + nearest * direction, {}};
  hit.normal = FrontNormal(scene_->elements()[hit_element], hit.position);
  return hit;
}

bool RayCaster::Touches(const SurfacePoint& point) const {
  const std::uint32_t carrier = point.element == ElementId::kNone ? kNoCarrier : scene_->element(point.element).carrier;
  const double end = 0;
  bool touches = false;
  // The ray of length 0 visits the boxes that hold the point.
  Walk(bvh_, Ray(point.position, {1, 1}), end, [&](std::uint32_t index) {
    const Element& element = scene_->elements()[index];
    touches = element.carrier != carrier && DistanceTo(element, point.position) <= scene_->touch_distance();
    return touches;
  });
  return touches;
}

bool RayCaster::Visible(const SurfacePoint& from, const SurfacePoint& to) const {
  const std::uint32_t from_carrier =
      from.element == ElementId::kNone ? kNoCarrier : scene_->element(from.element).carrier;
  const std::uint32_t to_carrier = to.element == ElementId::kNone ? kNoCarrier : scene_->element(to.element).carrier;
  const Vector2 direction = to.position - from.position;
  const Ray ray(from.position, direction);
  const double end = 1;
  bool blocked = false;
  Walk(bvh_, ray, end, [&](std::uint32_t index) {
    const Element& element = scene_->elements()[index];
    Crossings crossings;
    if (element.carrier == to_carrier) {
      // Both ends on one line or circle: nothing of it lies between. Else only its other crossing counts, seen from
      // `to`.
      if (element.kind == Element::Kind::kSegment || to_carrier == from_carrier) return false;
      crossings = CrossOwnCircle(element, to.position, -direction, scene_->touch_distance());
      if (crossings.count > 0) crossings.t[0] = 1 - crossings.t[0];
    } else {
      crossings = Cross(element, from, from_carrier, direction, scene_->touch_distance());
    }
    for (int i = 0; i < crossings.count; ++i) blocked |= crossings.t[i] > 0 && crossings.t[i] < 1;
    return blocked;
  });
  return !blocked;
}

}  // namespace flatlight
