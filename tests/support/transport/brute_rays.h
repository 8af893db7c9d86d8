// SPDX-License-Identifier: Apache-2.0
// What a ray caster must answer, bit for bit, by looking at every element.
#ifndef FLATLIGHT_TESTS_SUPPORT_TRANSPORT_BRUTE_RAYS_H_
#define FLATLIGHT_TESTS_SUPPORT_TRANSPORT_BRUTE_RAYS_H_

#include <optional>

#include "core/math/vec.h"
#include "core/plane/ray_caster.h"
#include "core/scene/scene.h"

namespace flatlight {

struct BruteHit {
  double distance = 0;
  ElementId element = ElementId::kNone;
};

std::optional<BruteHit> BruteClosestHit(const Scene& scene, const SurfacePoint& from, Vector2 direction);
bool BruteVisible(const Scene& scene, const SurfacePoint& from, const SurfacePoint& to);
bool BruteTouches(const Scene& scene, const SurfacePoint& point);

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_SUPPORT_TRANSPORT_BRUTE_RAYS_H_
