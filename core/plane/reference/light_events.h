// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_LIGHT_EVENTS_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_LIGHT_EVENTS_H_

#include <vector>

#include "core/plane/ray_caster.h"
#include "core/plane/reference/chart.h"

namespace flatlight {

// Where the hard shadows of lights without a surface may begin or end, by element, in its chart: there irradiance
// jumps. Unsorted.
std::vector<std::vector<double>> LightEvents(const RayCaster& caster, const std::vector<Chart>& charts);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_LIGHT_EVENTS_H_
