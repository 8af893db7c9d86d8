// SPDX-License-Identifier: Apache-2.0
// Lights without a surface: no ray finds them, one has to ask for them.
#ifndef FLATLIGHT_CORE_SCENE_LIGHT_H_
#define FLATLIGHT_CORE_SCENE_LIGHT_H_

#include <string>
#include <variant>

#include "core/math/vec.h"
#include "core/scene/spectrum.h"

namespace flatlight {

// Shines alike in all directions, or, a spot, in a cone: fully up to cone_angle from its axis, then less by a smooth
// step, and not at all from edge_angle on. Normalised coordinates.
struct PointLight {
  Point2 position;
  Spectrum intensity;  // Along the axis. Normalised flux per radian.
  Vector2 axis;        // Unit. Of no meaning if cone_angle is pi.
  double cone_angle = 0x1.921fb54442d18p+1;
  double edge_angle = 0x1.921fb54442d18p+1;

  // The share of `intensity` that goes along `direction` (of any length but 0), in [0, 1].
  double Share(Vector2 direction) const;
};

// Parallel light from infinitely far away.
struct DirectionalLight {
  Vector2 direction;    // Unit, in which the light goes.
  Spectrum irradiance;  // Of a curve that faces it. Normalised.
};

struct Light {
  std::string name;
  std::variant<PointLight, DirectionalLight> kind;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_SCENE_LIGHT_H_
