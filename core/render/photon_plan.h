// SPDX-License-Identifier: Apache-2.0
// What plans have of photon mapping.
#ifndef FLATLIGHT_CORE_RENDER_PHOTON_PLAN_H_
#define FLATLIGHT_CORE_RENDER_PHOTON_PLAN_H_

#include <string>

#include "core/render/settings.h"
#include "core/scene/diagnostic.h"
#include "core/scene/scene.h"

namespace flatlight {

// Reports settings of photon mapping that are out of range or that the method, whichever it is, has no use for, and
// scenes that it cannot do.
void CheckPhotonMapping(const Scene& scene, const Settings& settings, Diagnostics& diagnostics);

// Fills in what photon mapping takes where nothing was asked.
void FillPhotonDefaults(const Scene& scene, Settings& settings);

// The end of a plan's summary: ", from 65536 photons, by their density". Needs defaults.
std::string HowPhotonsTell(const Scene& scene, const Settings& settings);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_PHOTON_PLAN_H_
