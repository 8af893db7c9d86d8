// SPDX-License-Identifier: Apache-2.0
// Ray casting over the curves of a plane scene.
#ifndef FLATLIGHT_CORE_PLANE_RAY_CASTER_H_
#define FLATLIGHT_CORE_PLANE_RAY_CASTER_H_

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "core/math/vec.h"
#include "core/plane/bvh.h"
#include "core/plane/curve_grid.h"
#include "core/plane/ray_walk.h"
#include "core/scene/scene.h"

namespace flatlight {

// A point rays leave from or arrive at. On a curve `element` names the piece, so that a ray never hits the line or
// circle it leaves at the place it leaves it, and no epsilon is needed.
struct SurfacePoint {
  Point2 position;
  ElementId element = ElementId::kNone;
};

struct Ray {
  SurfacePoint from;
  Vector2 direction;
};

struct Hit {
  double distance = 0;  // In units of the direction's length.
  ElementId element = ElementId::kNone;
  Point2 position;
  Vector2 normal;  // Unit; the element's front, not turned toward the ray.
};

class RayCaster {
 public:
  explicit RayCaster(const std::shared_ptr<const Scene>& scene);

  // The caster of a scene that differs little from this one's: only what changed is done again. Null if so much changed
  // that a new one is better.
  std::shared_ptr<const RayCaster> Refit(const std::shared_ptr<const Scene>& after) const;

  // The first curve hit by from.position + t direction, t > 0. Ties break by (distance, element). Closed at shared end
  // points: a ray through a point where two curves meet, to the accuracy of the coordinates, hits one of them.
  std::optional<Hit> ClosestHit(const SurfacePoint& from, Vector2 direction) const;

  // The same for many rays, in less time than one after another. Spans of one length.
  void ClosestHits(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const;

  // True if nothing lies between two points, their own places on their own curves aside.
  bool Visible(const SurfacePoint& from, const SurfacePoint& to) const;

  // The same for many pairs of points, in less time than one after another. Spans of one length.
  void Visible(std::span<const SurfacePoint> from, std::span<const SurfacePoint> to, std::span<bool> visible) const;

  // Whether another line or circle than the point's own passes through it.
  bool Touches(const SurfacePoint& point) const;

  const Scene& scene() const { return *scene_; }
  // Built when it is first asked for. Safe to use from several threads.
  const Bvh& bvh() const;

 private:
  RayCaster(std::shared_ptr<const Scene> scene, CurveGrid grid);

  RayEnd EndAt(const SurfacePoint& point) const;
  Hit HitAt(const WalkRay& ray, const NearestCrossing& nearest) const;

  std::shared_ptr<const Scene> scene_;
  CurveGrid grid_;
  std::vector<std::uint32_t> carriers_;  // Of the elements, close together.
  mutable std::mutex bvh_mutex_;
  mutable std::atomic<bool> has_bvh_ = false;
  mutable std::optional<Bvh> bvh_;
  const RaySearches* searches_ = &ChosenRaySearches();
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_RAY_CASTER_H_
