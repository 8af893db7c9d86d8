// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_PLAN_PASSES_H_
#define FLATLIGHT_CORE_RENDER_PLAN_PASSES_H_

#include "core/render/plan.h"

namespace flatlight {

// Fills in the passes of a plan that has settings and skips: what is done, and how many rays that may take.
void AddPasses(const Scene& scene, Plan& plan);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_PLAN_PASSES_H_
