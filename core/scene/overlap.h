// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_SCENE_OVERLAP_H_
#define FLATLIGHT_CORE_SCENE_OVERLAP_H_

#include <vector>

#include "core/scene/scene.h"

namespace flatlight {

// Where pieces lie on one another (on one line or circle, to the distance `near`), the first one stays and the others
// are cut away there, so that a ray never meets two at once. This is the rule "ties break by order" made once instead
// of at every ray. The order of what stays is kept.
std::vector<Element> RemoveOverlaps(const std::vector<Element>& pieces, double near);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_SCENE_OVERLAP_H_
