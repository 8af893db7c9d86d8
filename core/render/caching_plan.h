// SPDX-License-Identifier: Apache-2.0
// What plans have of irradiance caching.
#ifndef FLATLIGHT_CORE_RENDER_CACHING_PLAN_H_
#define FLATLIGHT_CORE_RENDER_CACHING_PLAN_H_

#include <string>

#include "core/render/settings.h"
#include "core/scene/diagnostic.h"
#include "core/scene/scene.h"

namespace flatlight {

// Reports settings of irradiance caching that are out of range or that the method, whichever it is, has no use for, and
// scenes that it cannot do.
void CheckCaching(const Scene& scene, const Settings& settings, Diagnostics& diagnostics);

// Fills in what irradiance caching takes where nothing was asked.
void FillCachingDefaults(const Scene& scene, Settings& settings);

// The end of a plan's summary: ", from 10 records". Needs defaults.
std::string HowRecordsTell(const Settings& settings, bool direct);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_CACHING_PLAN_H_
