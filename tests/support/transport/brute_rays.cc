// SPDX-License-Identifier: Apache-2.0
#include "tests/support/transport/brute_rays.h"

#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/plane/intersect.h"
#include "core/plane/ray_walk.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

std::uint32_t CarrierOf(const Scene& scene, const SurfacePoint& point) {
  return point.element == ElementId::kNone ? kNoCarrier : scene.element(point.element).carrier;
}

Crossings CrossFrom(const Scene& scene, const Element& element, const SurfacePoint& from, Vector2 direction) {
  const bool own = element.carrier == CarrierOf(scene, from);
  if (element.kind == Element::Kind::kSegment) {
    return own ? Crossings{} : CrossSegment(element, from.position, direction, scene.touch_distance());
  }
  return own ? CrossOwnCircle(element, from.position, direction, scene.touch_distance())
             : CrossArc(element, from.position, direction, scene.touch_distance());
}

}  // namespace

std::optional<BruteHit> BruteClosestHit(const Scene& scene, const SurfacePoint& from, Vector2 direction) {
  std::optional<BruteHit> nearest;
  for (std::size_t e = 0; e < scene.elements().size(); ++e) {
    const Crossings crossings = CrossFrom(scene, scene.elements()[e], from, direction);
    for (int i = 0; i < crossings.count; ++i) {
      const double t = crossings.t[i];
      if (t > 0 && (!nearest || t < nearest->distance)) nearest = BruteHit{t, static_cast<ElementId>(e)};
    }
  }
  if (nearest && !(nearest->distance < std::numeric_limits<double>::infinity())) return std::nullopt;
  return nearest;
}

bool BruteVisible(const Scene& scene, const SurfacePoint& from, const SurfacePoint& to) {
  const std::uint32_t from_carrier = CarrierOf(scene, from), to_carrier = CarrierOf(scene, to);
  const Vector2 direction = to.position - from.position;
  for (const Element& element : scene.elements()) {
    if (element.carrier != to_carrier) {
      const Crossings crossings = CrossFrom(scene, element, from, direction);
      for (int i = 0; i < crossings.count; ++i)
        if (crossings.t[i] > 0 && crossings.t[i] < 1) return false;
      continue;
    }
    // Of a line or circle that the ray ends on only another crossing counts, and none if it begins there too.
    if (element.kind == Element::Kind::kSegment || to_carrier == from_carrier) continue;
    const Crossings crossings = CrossOwnCircle(element, to.position, -direction, scene.touch_distance());
    if (crossings.count > 0 && 1 - crossings.t[0] > 0 && 1 - crossings.t[0] < 1) return false;
  }
  return true;
}

bool BruteTouches(const Scene& scene, const SurfacePoint& point) {
  const std::uint32_t carrier = CarrierOf(scene, point);
  for (const Element& element : scene.elements()) {
    if (element.carrier != carrier && DistanceTo(element, point.position) <= scene.touch_distance()) return true;
  }
  return false;
}

}  // namespace flatlight
