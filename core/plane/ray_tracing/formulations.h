// SPDX-License-Identifier: Apache-2.0
// Derivatives of irradiance along a receiver from the rays of one gather, in three ways (THEORY 6, 17 A1 and A8, 18
// B3).
#ifndef FLATLIGHT_CORE_PLANE_RAY_TRACING_FORMULATIONS_H_
#define FLATLIGHT_CORE_PLANE_RAY_TRACING_FORMULATIONS_H_

#include <vector>

#include "core/plane/ray_tracing/hemicircle_gather.h"
#include "core/scene/scene.h"

namespace flatlight {

// Per arc length, and per arc length squared, along increasing arc length; and per radian as the normal turns toward
// the tangent.
struct GatherDerivatives {
  Spectrum first;
  Spectrum second;
  Spectrum rotation;
};

// Radiance jumps between neighbouring rays: at the break between them if it is known (LookPastEnds), else where their
// stretches meet; and jumps move by the break law. Sees occlusion.
GatherDerivatives StratifiedDerivatives(const Receiver& receiver, const std::vector<GatheredRay>& gathered);

// The hits are joined to a polyline that is closed at the horizon; each piece has the radiance of its farther end, and
// vertices move by the break law. Sees occlusion. (The idea of Schwarzhaupt et al. 2012 in the plane.)
GatherDerivatives PolylineDerivatives(const Receiver& receiver, const std::vector<GatheredRay>& gathered);

// Derivatives of the geometry term of what each ray meets. What comes into sight and what is covered is left out, so it
// is right only where nothing blocks anything, and edges of emitters are far from grazing (Jarosz et al. 2012).
GatherDerivatives ArcLengthDerivatives(const Receiver& receiver, const std::vector<GatheredRay>& gathered);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_RAY_TRACING_FORMULATIONS_H_
