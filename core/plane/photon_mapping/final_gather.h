// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_FINAL_GATHER_H_
#define FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_FINAL_GATHER_H_

#include <cstdint>

#include "core/execution/cancellation.h"
#include "core/plane/ray_tracing/ray_tree.h"
#include "core/scene/scene.h"

namespace flatlight {

// Reflected light at a receiver, as one gather of rays finds it: what comes straight from emitters is left out.
struct GatheredLight {
  Spectrum irradiance;
  Spectrum gradient;            // Per arc length along increasing arc length.
  Spectrum gradient_bias;       // Its error that falls with the number of rays, as half of them tell.
  double inverse_distance = 0;  // Of what the rays met, the mean weighed by the cosine.
  double cast = 0;              // Rays.
  bool whole = false;           // Not cancelled.
};

enum class GatherGradient : std::uint8_t { kLeftOut, kFound };

// `rays` rays, stratified over the hemicircle; each looks up what its tree knows of where it arrives.
GatheredLight GatherReflected(const RayTree& tree, const Receiver& receiver, std::uint32_t rays, std::uint64_t key,
                              GatherGradient gradient, const Cancellation& cancellation);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_FINAL_GATHER_H_
