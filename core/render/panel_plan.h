// SPDX-License-Identifier: Apache-2.0
// Which scenes panels can do: the reference, and records that gather from it.
#ifndef FLATLIGHT_CORE_RENDER_PANEL_PLAN_H_
#define FLATLIGHT_CORE_RENDER_PANEL_PLAN_H_

#include <string>

#include "core/scene/diagnostic.h"
#include "core/scene/scene.h"

namespace flatlight {

// Whether panels can tell light that a scene reflects, and its derivatives.
bool PanelsTellAll(const Scene& scene);

// The name of the first curve that reflects by a phong lobe; empty if there is none.
std::string NameOfPhongCurve(const Scene& scene);

// Both report why they cannot tell it, in a scene that reflects. `path`: of the setting that asks for them; `other`:
// what to use else. The first asks for derivatives as well.
void CheckPanelDerivatives(const Scene& scene, const std::string& path, const std::string& other,
                           Diagnostics& diagnostics);
void CheckPanels(const Scene& scene, const std::string& path, const std::string& other, Diagnostics& diagnostics);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_PANEL_PLAN_H_
