// SPDX-License-Identifier: Apache-2.0
// Bounds on light that need no solution.
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_BRIGHTEST_LIGHT_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_BRIGHTEST_LIGHT_H_

#include "core/scene/scene.h"

namespace flatlight {

// Stands for what nothing bounds, for results hold finite numbers alone.
inline constexpr double kUnbounded = 1e200;

// What lights without a surface add to the irradiance at a receiver, all of them seen and facing it: no less than they
// do.
Spectrum LightsAt(const Scene& scene, const Receiver& receiver);
// Radiance that no light of curves and sky exceeds, emitted or reflected any number of times; irradiance from it is at
// most twice that. Infinite where a curve reflects all light, or glass emits, so that nothing bounds it. Requires
// Lambertian curves, mirrors, glass and, if there are no lights without a surface, phong lobes alone.
Spectrum BrightestLight(const Scene& scene);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_BRIGHTEST_LIGHT_H_
