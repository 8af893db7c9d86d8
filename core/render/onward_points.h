// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_ONWARD_POINTS_H_
#define FLATLIGHT_CORE_RENDER_ONWARD_POINTS_H_

#include "core/plane/ray_caster.h"
#include "core/scene/scene.h"

namespace flatlight {

// Where a receiver lies on another curve as well, what counts is what lies beyond, toward increasing arc length: the
// receiver moved there, as little as makes it touch nothing else.
struct OnwardPoint {
  Receiver receiver;
  double step = 0;  // How far; 0 where it touches nothing.
};
OnwardPoint MovedOnward(const Receiver& receiver, const RayCaster& caster);

// Of irradiance that comes from all directions at a radiance of 1, how much rays from there may miss: an end that the
// receiver touches is behind it, at the horizon, and rays that pass it nearer than the touch distance are taken to hit.
double MissedAtHorizon(const OnwardPoint& point, const Scene& scene);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_ONWARD_POINTS_H_
