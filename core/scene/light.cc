// SPDX-License-Identifier: Apache-2.0
#include "core/scene/light.h"

#include <cmath>
#include <numbers>

#include "core/math/trig.h"

namespace flatlight {

double PointLight::Share(Vector2 direction) const {
  if (cone_angle >= std::numbers::pi) return 1;
  const double angle = AngleOf(Dot(axis, direction), std::abs(Cross(axis, direction)));
  if (angle <= cone_angle) return 1;
  if (angle >= edge_angle) return 0;
  const double t = (edge_angle - angle) / (edge_angle - cone_angle);
  return t * t * (3 - 2 * t);
}

}  // namespace flatlight
