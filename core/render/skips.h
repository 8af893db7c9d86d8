// SPDX-License-Identifier: Apache-2.0
// Work that a plan may leave out.
#ifndef FLATLIGHT_CORE_RENDER_SKIPS_H_
#define FLATLIGHT_CORE_RENDER_SKIPS_H_

#include <vector>

#include "core/render/plan.h"
#include "core/render/settings.h"
#include "core/scene/scene.h"

namespace flatlight {

namespace skip {
inline constexpr char kEmission[] = "emission";                 // All light, where nothing emits.
inline constexpr char kColour[] = "colour";                     // Two of three channels, where all spectra are grey.
inline constexpr char kVisibility[] = "visibility";             // Shadow tests, where nothing can block.
inline constexpr char kBounces[] = "bounces";                   // Reflections, where nothing lit reflects.
inline constexpr char kBlackPaths[] = "black-paths";            // What follows a hit on a black curve.
inline constexpr char kUnseenEmitters[] = "unseen-emitters";    // Emitters whose light comes to nothing that counts.
inline constexpr char kConvergedPoints[] = "converged-points";  // Samples of points that meet the target error.
}  // namespace skip

// Every skip with its decision and reason, in a fixed order. `settings` must have its defaults filled in.
std::vector<SkipEntry> DecideSkips(const Scene& scene, const Settings& settings);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_SKIPS_H_
