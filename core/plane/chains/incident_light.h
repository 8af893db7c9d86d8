// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_CHAINS_INCIDENT_LIGHT_H_
#define FLATLIGHT_CORE_PLANE_CHAINS_INCIDENT_LIGHT_H_

#include "core/math/vec.h"
#include "core/scene/spectrum.h"

namespace flatlight {

// Light that comes to a place from one direction.
struct IncidentLight {
  Vector2 direction;    // Unit, to where it comes from.
  double cosine = 0;    // At the place; positive.
  Spectrum irradiance;  // Of a curve that faces it.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_CHAINS_INCIDENT_LIGHT_H_
