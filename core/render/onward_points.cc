// SPDX-License-Identifier: Apache-2.0
#include "core/render/onward_points.h"

#include "core/math/tolerances.h"

namespace flatlight {

OnwardPoint MovedOnward(const Receiver& receiver, const RayCaster& caster) {
  OnwardPoint moved{receiver, 0};
  if (!caster.Touches({receiver.position, receiver.element})) return moved;
  double step = kOnwardTouches * caster.scene().touch_distance();
  do {
    moved.step = step;
    moved.receiver.position =
        receiver.position + step * receiver.tangent + 0.5 * receiver.curvature * step * step * receiver.normal;
    step *= 2;
  } while (step <= kFarthestOnward && caster.Touches({moved.receiver.position, receiver.element}));
  return moved;
}

double MissedAtHorizon(const OnwardPoint& point, const Scene& scene) {
  if (point.step == 0) return 0;
  // 1 - cos of the angle, twice that for rounding.
  const double sine = scene.touch_distance() / point.step;
  return sine * sine;
}

}  // namespace flatlight
