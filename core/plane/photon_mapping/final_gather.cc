// SPDX-License-Identifier: Apache-2.0
#include "core/plane/photon_mapping/final_gather.h"

#include <vector>

#include "core/plane/ray_tracing/formulations.h"
#include "core/plane/ray_tracing/hemicircle_gather.h"

namespace flatlight {

GatheredLight GatherReflected(const RayTree& tree, const Receiver& receiver, std::uint32_t rays, std::uint64_t key,
                              GatherGradient gradient, const Cancellation& cancellation) {
  GatheredLight light;
  std::vector<GatheredRay> gathered;
  gathered.reserve(rays + std::size_t{1});
  const auto leave_out_emitted = [&] {
    for (GatheredRay& ray : gathered) {
      if (tree.emission() == Emission::kSeen)
        ray.radiance = ray.radiance + -1.0 * EmittedToward(tree.caster().scene(), receiver, ray);
    }
  };
  GatherHemicircle(tree, receiver, rays, key, cancellation, gathered, light.cast);
  if (cancellation.cancelled()) return light;
  for (const GatheredRay& ray : gathered) light.inverse_distance += 0.5 * (ray.end - ray.begin) * ray.InverseDistance();
  if (gradient == GatherGradient::kFound) {
    std::vector<GatheredRay> known = gathered;
    LookPastEnds(tree, receiver, rays, key, cancellation, gathered, light.cast);
    if (cancellation.cancelled()) return light;
    leave_out_emitted();
    light.gradient = StratifiedDerivatives(receiver, gathered).first;
    gathered = std::move(known);
  }
  leave_out_emitted();
  light.irradiance = IrradianceOf(gathered);
  light.whole = true;
  return light;
}

}  // namespace flatlight
