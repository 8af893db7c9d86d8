// SPDX-License-Identifier: Apache-2.0
// Direct irradiance from rays that look at every element.
#ifndef FLATLIGHT_TESTS_BENCH_STRESS_BRUTE_FORCE_H_
#define FLATLIGHT_TESTS_BENCH_STRESS_BRUTE_FORCE_H_

#include "core/scene/scene.h"
#include "tests/support/transport/brute_rays.h"

namespace flatlight::stress {

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
