// SPDX-License-Identifier: Apache-2.0
#include "core/plane/ray_caster.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "core/math/check.h"
#include "core/plane/ray_walk.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

constexpr std::size_t kBatch = 64;
// Smaller trees stay in the nearest cache: there, walks that take turns cost more than they save.
constexpr std::size_t kWorthTurns = 512;

}  // namespace

RayCaster::RayCaster(std::shared_ptr<const Scene> scene) : scene_(std::move(scene)), bvh_(*scene_) {}

RayEnd RayCaster::EndAt(const SurfacePoint& point) const {
  return {point.position, point.element == ElementId::kNone ? kNoCarrier : scene_->element(point.element).carrier};
}

Hit RayCaster::HitAt(const WalkRay& ray, const NearestCrossing& nearest) const {
  Hit hit{nearest.t, static_cast<ElementId>(nearest.element), ray.from.position + nearest.t * ray.direction, {}};
  // A segment's ends are in the cache, unlike its element.
  const Bvh::Slot& slot = bvh_.slots()[nearest.slot];
  hit.normal = nearest.straight ? Left(Normalized(slot.b - slot.a))
                                : FrontNormal(scene_->elements()[nearest.element], hit.position);
  return hit;
}

std::optional<Hit> RayCaster::ClosestHit(const SurfacePoint& from, Vector2 direction) const {
  const WalkRay ray{EndAt(from), direction};
  const NearestCrossing nearest = searches_->nearest(*scene_, bvh_, ray);
  if (nearest.t == std::numeric_limits<double>::infinity()) return std::nullopt;
  return HitAt(ray, nearest);
}

void RayCaster::ClosestHits(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const {
  FLATLIGHT_DCHECK(rays.size() == hits.size());
  if (bvh_.nodes().size() < kWorthTurns) {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = ClosestHit(rays[i].from, rays[i].direction);
    return;
  }
  std::array<WalkRay, kBatch> walk_rays;
  std::array<NearestCrossing, kBatch> nearest;
  for (std::size_t begin = 0; begin < rays.size(); begin += kBatch) {
    const std::size_t count = std::min(kBatch, rays.size() - begin);
    for (std::size_t i = 0; i < count; ++i) walk_rays[i] = {EndAt(rays[begin + i].from), rays[begin + i].direction};
    searches_->nearest_of_many(*scene_, bvh_, std::span(walk_rays).first(count), std::span(nearest).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      const bool met = nearest[i].t < std::numeric_limits<double>::infinity();
      hits[begin + i] = met ? std::optional(HitAt(walk_rays[i], nearest[i])) : std::nullopt;
    }
  }
}

bool RayCaster::Visible(const SurfacePoint& from, const SurfacePoint& to) const {
  return !searches_->blocked(*scene_, bvh_, EndAt(from), EndAt(to));
}

void RayCaster::Visible(std::span<const SurfacePoint> from, std::span<const SurfacePoint> to,
                        std::span<bool> visible) const {
  FLATLIGHT_DCHECK(from.size() == to.size() && from.size() == visible.size());
  if (bvh_.nodes().size() < kWorthTurns) {
    for (std::size_t i = 0; i < from.size(); ++i) visible[i] = Visible(from[i], to[i]);
    return;
  }
  std::array<RayEnd, kBatch> begins, ends;
  for (std::size_t first = 0; first < from.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, from.size() - first);
    for (std::size_t i = 0; i < count; ++i) begins[i] = EndAt(from[first + i]), ends[i] = EndAt(to[first + i]);
    const std::span<bool> results = visible.subspan(first, count);
    searches_->blocked_of_many(*scene_, bvh_, std::span(begins).first(count), std::span(ends).first(count), results);
    for (bool& result : results) result = !result;
  }
}

bool RayCaster::Touches(const SurfacePoint& point) const { return searches_->touched(*scene_, bvh_, EndAt(point)); }

}  // namespace flatlight
