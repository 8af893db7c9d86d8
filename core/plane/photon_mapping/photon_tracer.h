// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_PHOTON_TRACER_H_
#define FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_PHOTON_TRACER_H_

#include <cstdint>
#include <memory>
#include <vector>

#include "core/plane/light_tracing/light_tracer.h"
#include "core/plane/photon_mapping/stretches.h"
#include "core/sampling/sample_stream.h"
#include "core/scene/scene.h"

namespace flatlight {

// Light that has arrived on a curve.
struct Photon {
  SideId side{};
  double at = 0;            // By arc length along the side's stretch.
  Spectrum flux;            // Over the number of its path's kind: see PhotonMaps. Normalised.
  std::uint32_t depth = 0;  // Reflections and refractions before.
};

// What photons are wanted for.
enum class PhotonPurpose : std::uint8_t {
  kReflectors,  // Irradiance of what reflects diffusely, for rays that look for it there.
  kProbes,      // Irradiance on the curves with points.
};

// Photons are followed on until they have less than this share of the flux that they began with: then the one path
// tells of several places, which costs a ray each, where a path that ends by chance tells of fewer and costs an
// emission too.
inline constexpr double kLeastPhotonShare = 0.125;

// Traces photons, and keeps those that are wanted.
class PhotonTracer {
 public:
  // All must outlive this. `probes`: has the probes; its world is that of the tracer's scene.
  PhotonTracer(const LightTracer& tracer, const Scene& scene, const Scene& probes, const Stretches& stretches,
               PhotonPurpose purpose, std::uint32_t most_bounces);

  // Adds those of path `index`. Returns the rays cast.
  double Trace(const SampleStream& stream, std::uint32_t index, std::vector<Photon>& photons) const;

 private:
  const LightTracer& tracer_;
  const Scene& scene_;
  const Stretches& stretches_;
  PhotonPurpose purpose_;
  std::uint32_t most_bounces_;
  std::vector<char> has_probe_;  // By curve.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_PHOTON_TRACER_H_
