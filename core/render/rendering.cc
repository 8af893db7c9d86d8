// SPDX-License-Identifier: Apache-2.0
#include "core/render/rendering.h"

#include <utility>

#include "core/render/exact_rendering.h"
#include "core/render/path_tracing_rendering.h"

namespace flatlight {

std::unique_ptr<Rendering> StartRendering(std::shared_ptr<const Scene> scene, const Plan& plan) {
  if (plan.settings.method == Method::kExact) return std::make_unique<ExactRendering>(std::move(scene), plan);
  return std::make_unique<PathTracingRendering>(std::move(scene), plan);
}

}  // namespace flatlight
