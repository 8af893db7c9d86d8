// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_LIGHT_SERIES_H_
#define FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_LIGHT_SERIES_H_

#include <optional>

#include "core/plane/irradiance_caching/break_series.h"
#include "core/plane/ray_caster.h"
#include "core/scene/light.h"
#include "core/scene/scene.h"

namespace flatlight {

// Irradiance from a light without a surface, for one unit of its intensity or irradiance, as the receiver moves along a
// line or circle; absent where the light is below the horizon or something blocks it.
std::optional<ArcSeries> LightSeries(const Light& light, const Receiver& receiver, const RayCaster& caster);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_LIGHT_SERIES_H_
