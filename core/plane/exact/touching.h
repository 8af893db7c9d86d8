// SPDX-License-Identifier: Apache-2.0
// What a receiver sees of an element that passes through it, just beyond the receiver toward increasing arc length.
#ifndef FLATLIGHT_CORE_PLANE_EXACT_TOUCHING_H_
#define FLATLIGHT_CORE_PLANE_EXACT_TOUCHING_H_

#include "core/plane/exact/part.h"
#include "core/scene/scene.h"

namespace flatlight {

// Whether an element of another line or circle than the receiver's passes through it: the rule that rays follow.
bool TouchesReceiver(const Scene& scene, const Element& element, const Receiver& receiver);

// The parts of such an element, in the limit. The element is taken to pass through the receiver exactly, and its
// direction and curvature there decide: no place nearby, whose sides would be rounding, is looked from.
Parts TouchingParts(const Scene& scene, ElementId id, const Receiver& receiver);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_EXACT_TOUCHING_H_
