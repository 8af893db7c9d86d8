// SPDX-License-Identifier: Apache-2.0
#include "core/plane/photon_mapping/final_gather.h"

#include <cstddef>
#include <vector>

#include "core/plane/ray_tracing/formulations.h"
#include "core/plane/ray_tracing/hemicircle_gather.h"

namespace flatlight {
namespace {

// An error that goes with the distance of rays, or its root where an end is grazed, is at most so many times as large
// as the difference that half of the rays make.
constexpr double kOfDifference = 2;

// About what half as many rays would have met, with what is known between them.
std::vector<GatheredRay> Thinned(const std::vector<GatheredRay>& gathered) {
  std::vector<GatheredRay> thinned;
  thinned.reserve(gathered.size());
  bool every_other = false;
  std::size_t left_out = gathered.size();
  for (std::size_t k = 0; k < gathered.size(); ++k) {
    GatheredRay ray = gathered[k];
    if (k > 0 && left_out == k - 1 && !ray.break_before) {
      ray.break_before = gathered[left_out].break_before;
      ray.begin = 0.5 * (gathered[left_out].begin + gathered[left_out].end);
    }
    const bool of_stretch = gathered[k].begin < gathered[k].end;
    if (every_other && of_stretch && k + 1 < gathered.size()) {
      const GatheredRay &before = thinned.back(), &after = gathered[k + 1];
      // One that is alone with what it met stays.
      const bool like_before = !ray.break_before && (!after.break_before || before.element == ray.element);
      const bool like_after = ray.break_before && !after.break_before && after.element == ray.element;
      if (like_before || like_after) {
        left_out = k;
        every_other = false;
        continue;
      }
    }
    if (of_stretch) every_other = !every_other;
    thinned.push_back(ray);
  }
  return thinned;
}

}  // namespace

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
    const Spectrum of_half = StratifiedDerivatives(receiver, Thinned(gathered)).first;
    light.gradient_bias = kOfDifference * (of_half + -1.0 * light.gradient);
    gathered = std::move(known);
  }
  leave_out_emitted();
  light.irradiance = IrradianceOf(gathered);
  light.whole = true;
  return light;
}

}  // namespace flatlight
