// SPDX-License-Identifier: Apache-2.0
// What a ray caster must answer, bit for bit, by looking at every element; and direct irradiance from such rays.
#ifndef FLATLIGHT_TESTS_BENCH_STRESS_BRUTE_FORCE_H_
#define FLATLIGHT_TESTS_BENCH_STRESS_BRUTE_FORCE_H_

#include <optional>

#include "core/plane/ray_caster.h"
#include "core/scene/scene.h"

namespace flatlight::stress {

struct BruteHit {
  double distance = 0;
  ElementId element = ElementId::kNone;
};

std::optional<BruteHit> BruteClosestHit(const Scene& scene, const SurfacePoint& from, Vector2 direction);
bool BruteVisible(const Scene& scene, const SurfacePoint& from, const SurfacePoint& to);
bool BruteTouches(const Scene& scene, const SurfacePoint& point);

// Rounding beside that of the scene itself.
struct Disturbance {
  double position = 0;   // Of every point; normalised.
  double direction = 0;  // rad, of the receiver.
};

// Irradiance of the first channel, normalised: every direction in which something may begin or end is looked up, they
// are sorted, and one ray is cast between every two neighbours. `uncertain` bounds what the rounding of coordinates can
// do to it: places where curves cross at a small angle, or touch, move far.
struct BruteIrradiance {
  double value = 0;
  double uncertain = 0;
};
BruteIrradiance IrradianceByRays(const Scene& scene, const Receiver& receiver, const Disturbance& disturbance = {});

}  // namespace flatlight::stress

#endif  // FLATLIGHT_TESTS_BENCH_STRESS_BRUTE_FORCE_H_
