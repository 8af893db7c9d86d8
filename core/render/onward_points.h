// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_ONWARD_POINTS_H_
#define FLATLIGHT_CORE_RENDER_ONWARD_POINTS_H_

#include "core/plane/ray_caster.h"
#include "core/scene/scene.h"

namespace flatlight {

// Where a receiver lies on another curve as well, what counts is what lies beyond, toward increasing arc length: the
// receiver moved there, as little as makes it touch nothing else.
Receiver MovedOnward(const Receiver& receiver, const RayCaster& caster);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_ONWARD_POINTS_H_
