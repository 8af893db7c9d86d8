// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_WORLD_UNITS_H_
#define FLATLIGHT_CORE_RENDER_WORLD_UNITS_H_

#include "core/scene/scene.h"

namespace flatlight {

// The place where results leave normalised units.
struct WorldUnits {
  double irradiance;
  double gradient;
  double hessian;

  explicit WorldUnits(const Frame& frame)
      : irradiance(frame.radiance_scale),
        gradient(frame.radiance_scale / frame.scale),
        hessian(frame.radiance_scale / frame.scale / frame.scale) {}
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_WORLD_UNITS_H_
