// SPDX-License-Identifier: Apache-2.0
// Which ways light can take in a scene, as far as a look at the description tells.
#ifndef FLATLIGHT_CORE_RENDER_LIGHT_PATHS_H_
#define FLATLIGHT_CORE_RENDER_LIGHT_PATHS_H_

#include "core/render/settings.h"
#include "core/scene/scene.h"

namespace flatlight {

// Nothing shines.
bool AllDark(const Scene& scene);

// Nothing reflects, or no reflection is wanted.
bool DirectLightOnly(const Scene& scene, const Settings& settings);

// Lights without a surface may shine where mirrors or glass pass their light on.
bool HasChainedLight(const Scene& scene);

// Whether it is certain that no curve stands between any two points of curves and probes that see each other's sides:
// each straight piece has all other pieces and all points in one of its closed half planes (a convex room, facing
// walls). A segment between two points of a closed half plane crosses its edge only if both lie on it. Gives up, false,
// where there are arcs, or many free points near many pieces.
bool NothingBlocks(const Scene& scene);

// Whether every curve keeps all light of some channel and curves that nothing crosses form a closed loop: in it light
// would never fade, and a path never end.
bool LightNeverFades(const Scene& scene);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_LIGHT_PATHS_H_
