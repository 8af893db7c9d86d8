// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_TRACK_EVENTS_H_
#define FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_TRACK_EVENTS_H_

#include <span>
#include <vector>

#include "core/cache/record.h"
#include "core/execution/cancellation.h"
#include "core/plane/irradiance_caching/skyline.h"
#include "core/plane/irradiance_caching/track.h"

namespace flatlight {

// The events between neighbouring ones of some places in order, each found by halving the way between two places that
// see different things. Those that undo each other between two places are missed.
std::vector<VisibilityEvent> EventsBetween(Skyline& skyline, const Track& track, std::span<const double> places,
                                           const Cancellation& cancellation);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_TRACK_EVENTS_H_
