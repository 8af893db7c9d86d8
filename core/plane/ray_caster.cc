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
// Smaller grids stay in the near caches: there, preparing many rays at once costs more than it saves.
constexpr std::size_t kWorthPreparing = 2048;  // Blocks.

}  // namespace

RayCaster::RayCaster(const std::shared_ptr<const Scene>& scene) : RayCaster(scene, CurveGrid(*scene)) {}

RayCaster::RayCaster(std::shared_ptr<const Scene> scene, CurveGrid grid)
    : scene_(std::move(scene)), grid_(std::move(grid)) {
  carriers_.reserve(scene_->elements().size());
  for (const Element& element : scene_->elements()) carriers_.push_back(element.carrier);
}

std::shared_ptr<const RayCaster> RayCaster::Refit(const std::shared_ptr<const Scene>& after) const {
  std::optional<CurveGrid> grid = grid_.Refit(*scene_, *after);
  if (!grid) return nullptr;
  // Not make_shared, which does not know the constructor.
  std::shared_ptr<RayCaster> refitted(new RayCaster(after, std::move(*grid)));
  if (has_bvh_) {
    refitted->bvh_ = bvh_->Refit(*scene_, *after);
    refitted->has_bvh_ = refitted->bvh_.has_value();
  }
  return refitted;
}

const Bvh& RayCaster::bvh() const {
  if (!has_bvh_) {
    const std::lock_guard lock(bvh_mutex_);
    if (!bvh_) bvh_.emplace(*scene_);
    has_bvh_ = true;
  }
  return *bvh_;
}

RayEnd RayCaster::EndAt(const SurfacePoint& point) const {
  return {point.position,
          point.element == ElementId::kNone ? kNoCarrier : carriers_[static_cast<std::size_t>(point.element)]};
}

Hit RayCaster::HitAt(const WalkRay& ray, const NearestCrossing& nearest) const {
  Hit hit{nearest.t, static_cast<ElementId>(nearest.element), ray.from.position + nearest.t * ray.direction, {}};
  if (nearest.block != kNoBlock) {
    // At hand, unlike the element.
    const CurveBlock& block = grid_.blocks()[nearest.block];
    const std::uint32_t lane = nearest.lane;
    hit.normal = Left(Normalized(Point2{block.bx[lane], block.by[lane]} - Point2{block.ax[lane], block.ay[lane]}));
  } else {
    hit.normal = FrontNormal(scene_->elements()[nearest.element], hit.position);
  }
  return hit;
}

std::optional<Hit> RayCaster::ClosestHit(const SurfacePoint& from, Vector2 direction) const {
  const WalkRay ray{EndAt(from), direction};
  const NearestCrossing nearest = searches_->nearest(*scene_, grid_, ray);
  if (nearest.t == std::numeric_limits<double>::infinity()) return std::nullopt;
  return HitAt(ray, nearest);
}

void RayCaster::ClosestHits(std::span<const Ray> rays, std::span<std::optional<Hit>> hits) const {
  FLATLIGHT_DCHECK(rays.size() == hits.size());
  if (grid_.blocks().size() < kWorthPreparing) {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = ClosestHit(rays[i].from, rays[i].direction);
    return;
  }
  std::array<WalkRay, kBatch> walk_rays;
  std::array<NearestCrossing, kBatch> nearest;
  for (std::size_t begin = 0; begin < rays.size(); begin += kBatch) {
    const std::size_t count = std::min(kBatch, rays.size() - begin);
    for (std::size_t i = 0; i < count; ++i) walk_rays[i] = {EndAt(rays[begin + i].from), rays[begin + i].direction};
    searches_->nearest_of_many(*scene_, grid_, std::span(walk_rays).first(count), std::span(nearest).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      const bool met = nearest[i].t < std::numeric_limits<double>::infinity();
      hits[begin + i] = met ? std::optional(HitAt(walk_rays[i], nearest[i])) : std::nullopt;
    }
  }
}

bool RayCaster::Visible(const SurfacePoint& from, const SurfacePoint& to) const {
  return !searches_->blocked(*scene_, grid_, EndAt(from), EndAt(to));
}

void RayCaster::Visible(std::span<const SurfacePoint> from, std::span<const SurfacePoint> to,
                        std::span<bool> visible) const {
  FLATLIGHT_DCHECK(from.size() == to.size() && from.size() == visible.size());
  if (grid_.blocks().size() < kWorthPreparing) {
    for (std::size_t i = 0; i < from.size(); ++i) visible[i] = Visible(from[i], to[i]);
    return;
  }
  std::array<RayEnd, kBatch> begins, ends;
  for (std::size_t first = 0; first < from.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, from.size() - first);
    for (std::size_t i = 0; i < count; ++i) begins[i] = EndAt(from[first + i]), ends[i] = EndAt(to[first + i]);
    const std::span<bool> results = visible.subspan(first, count);
    searches_->blocked_of_many(*scene_, grid_, std::span(begins).first(count), std::span(ends).first(count), results);
    for (bool& result : results) result = !result;
  }
}

bool RayCaster::Touches(const SurfacePoint& point) const { return searches_->touched(*scene_, grid_, EndAt(point)); }

}  // namespace flatlight
