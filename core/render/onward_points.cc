// SPDX-License-Identifier: Apache-2.0
#include "core/render/onward_points.h"

#include "core/math/tolerances.h"

namespace flatlight {

Receiver MovedOnward(const Receiver& receiver, const RayCaster& caster) {
  if (!caster.Touches({receiver.position, receiver.element})) return receiver;
  Receiver moved = receiver;
  double step = kOnwardTouches * caster.scene().touch_distance();
  do {
    moved.position =
        receiver.position + step * receiver.tangent + 0.5 * receiver.curvature * step * step * receiver.normal;
    step *= 2;
  } while (step <= kFarthestOnward && caster.Touches({moved.position, moved.element}));
  return moved;
}

}  // namespace flatlight
