// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_SCENE_ATTACH_H_
#define FLATLIGHT_CORE_SCENE_ATTACH_H_

#include <vector>

#include "core/scene/scene.h"

namespace flatlight {

// Finds the element each receiver lies on (within `near` of it), by position alone, and sets Receiver::element:
// where two meet, to that which goes on along the receiver's tangent, and of those that do to the straightest, one that
// bends away from its normal before one that bends to it: a circle on a floor stands above the receiver. One whose
// normal is not that of the curve it lies on (a free point may be turned) gets none; it is lifted off the curve toward
// its normal instead, as far as it takes to be on that side of all that meet there, and moved on along its tangent from
// what runs along its normal.
// Béziers are asked themselves, not the elements that follow them.
void AttachReceivers(const Scene& scene, double near, std::vector<Receiver*> receivers);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_SCENE_ATTACH_H_
