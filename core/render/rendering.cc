// SPDX-License-Identifier: Apache-2.0
#include "core/render/rendering.h"

#include <utility>

#include "core/render/exact_picture_rendering.h"
#include "core/render/exact_rendering.h"
#include "core/render/fluence_rendering.h"
#include "core/render/irradiance_caching_rendering.h"
#include "core/render/joint_rendering.h"
#include "core/render/path_tracing_rendering.h"
#include "core/render/photon_mapping_rendering.h"
#include "core/render/ray_tracing_rendering.h"
#include "core/render/reference_rendering.h"
#include "core/render/skips.h"

namespace flatlight {

std::unique_ptr<Rendering> StartRendering(std::shared_ptr<const Scene> scene, const Plan& plan, IndexCache& indexes,
                                          const std::string& sharers) {
  // In the dark no ray is cast.
  auto caster = plan.Takes(skip::kEmission) ? nullptr : indexes.For(scene, sharers);
  if (plan.settings.method == Method::kExact) {
    auto triangulation = plan.triangles ? indexes.TrianglesFor(scene, sharers) : nullptr;
    const bool points = scene->traits().probe_points > 0;
    if (scene->traits().pixels == 0) return std::make_unique<ExactRendering>(scene, caster, triangulation, plan);
    auto pictures = std::make_unique<ExactPictureRendering>(scene, caster, triangulation, plan);
    if (!points) return pictures;
    return std::make_unique<JointRendering>(std::make_unique<ExactRendering>(scene, caster, triangulation, plan),
                                            std::move(pictures));
  }
  if (plan.settings.method == Method::kRayTracing) {
    return std::make_unique<RayTracingRendering>(std::move(scene), std::move(caster), plan);
  }
  if (plan.settings.method == Method::kPhotonMapping) {
    return std::make_unique<PhotonMappingRendering>(std::move(scene), std::move(caster), plan);
  }
  if (plan.settings.method == Method::kIrradianceCaching) {
    return std::make_unique<IrradianceCachingRendering>(std::move(scene), std::move(caster), plan);
  }
  if (plan.settings.method == Method::kReference) {
    return std::make_unique<ReferenceRendering>(std::move(scene), caster, plan, indexes.solved_worlds(), sharers);
  }
  const SceneTraits& traits = scene->traits();
  if (traits.pixels == 0) return std::make_unique<PathTracingRendering>(std::move(scene), std::move(caster), plan);
  auto pictures = std::make_unique<FluenceRendering>(scene, caster, plan);
  if (traits.probe_points == 0) return pictures;
  auto points = std::make_unique<PathTracingRendering>(std::move(scene), std::move(caster), plan);
  return std::make_unique<JointRendering>(std::move(points), std::move(pictures));
}

std::unique_ptr<Rendering> StartRendering(std::shared_ptr<const Scene> scene, const Plan& plan) {
  IndexCache alone(0);
  return StartRendering(std::move(scene), plan, alone);
}

}  // namespace flatlight
