// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_INDEX_GROWTH_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_INDEX_GROWTH_H_

#include "core/scene/scene.h"
#include "core/scene/spectrum.h"

namespace flatlight {

// How many times larger the index of refraction may be at one place than at another, at most. Bodies of glass whose
// borders close count where they may lie in one another, all other borders count everywhere.
double IndexGrowth(const Scene& scene);

// The most light of radiance 1 may grow to where mirrors emit: on its way it meets the same ones again and again.
// Infinite where it does not fade. 1 where no mirror nor glass emits.
Spectrum GlowGrowth(const Scene& scene);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_INDEX_GROWTH_H_
