// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_PATH_TRACING_PATH_TRACER_H_
#define FLATLIGHT_CORE_PLANE_PATH_TRACING_PATH_TRACER_H_

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/execution/cancellation.h"
#include "core/plane/chains/chain_lights.h"
#include "core/plane/materials/scattering.h"
#include "core/plane/path_tracing/emitter_sampler.h"
#include "core/plane/path_tracing/emitter_sights.h"
#include "core/plane/path_tracing/light_sampler.h"
#include "core/plane/path_tracing/vertex.h"
#include "core/plane/ray_caster.h"
#include "core/sampling/sample_stream.h"
#include "core/scene/scene.h"

namespace flatlight {

struct PathTracingOptions {
  std::optional<std::uint32_t> max_bounces;  // Reflections between emitter and receiver. Absent: all.
  bool nothing_blocks = false;               // It is certain that no curve stands between emitters and points.
  bool nothing_reflects = false;             // No light comes to a curve that reflects.
  // Work that a scene may not need. Where they are allowed these change no result.
  bool one_channel = false;            // Allowed if all spectra are grey.
  bool leave_out_shadow_rays = false;  // Where nothing can block them.
  bool end_black_paths = false;        // Ends a path where it meets a black surface.
  // Those of which no light comes to a receiver or, with bounces, to a curve that reflects. At most
  // EmitterSampler::kMostWeighed pieces must emit, so that the others are sampled as they would be anyway.
  std::vector<ElementId> unseen_emitters;
};

template <int kChannels>
class PathWalk;

// Irradiance by paths from the receiver. At the receiver and on Lambertian curves the light of emitters to which the
// way is clear is added in closed form, the others are sampled, and the path goes on in a direction with density
// cos(theta)/2 (sin(theta) uniform); both reach emitters and are combined by the power heuristic (Veach 1997, 9.2) with
// densities per angle. Without other curves, with reflectance rho
//   E = (sampled emitters) + w 2 Le(hit) + rho(hit) E(hit, on the side that was hit).
// Glossy curves sample emitters and their own lobe in the same way, mirrors and glass go on in the one direction there
// is. Paths of a camera's pixel begin with a direction in it, all alike likely, and give the radiance that comes along
// it. Light of lights without a surface is added at every vertex that is not specular, straight and over mirrors and
// glass. The environment is found by chance.
// Russian roulette ends paths of small weight and divides survivors by their chance: no length is too long to count.
class PathTracer {
 public:
  PathTracer(std::shared_ptr<const RayCaster> caster, const PathTracingOptions& options);

  // 1 or 3.
  int channels() const { return channels_; }

  // A receiver and what its paths have in common. Keeps a reference to the tracer.
  class Start {
   public:
    Start(const PathTracer& tracer, const Receiver& receiver, const EmitterSight& sight);
    Start(const Start&) = delete;
    Start& operator=(const Start&) = delete;

   private:
    friend class PathTracer;
    template <int kChannels>
    friend class PathWalk;
    const PathTracer& tracer_;
    Vertex vertex_;
    EmitterSampler::View view_;
    double half_angle_;
    std::vector<ChainedLight> chained_;  // Comes over mirrors and glass from lights without a surface.
  };

  // What shapes tell of the ways from the receiver to the emitters: worth remembering.
  EmitterSight SightFrom(const Receiver& receiver) const { return sights_.FromPoint(VertexAt(scene_, receiver)); }

  // What the emitters that may be blocked or not, and the sky, would give the receiver if nothing blocked them: the
  // most by which finding a ray blocked or not can change a sample of direct light.
  Spectrum DirectStep(const Receiver& receiver, const EmitterSight& sight) const;
  // In any direction.
  Spectrum BrightestEmission() const;
  // What a path adds that finds the brightest place there may be after one reflection: one in the full light of the
  // brightest emitter, on the curve that reflects most.
  Spectrum BrightestReflection() const;
  // The rounding of direct light, which all samples share.
  Spectrum DirectRounding(const Receiver& receiver, const EmitterSight& sight) const;

  // Adds the estimate of one path to `irradiance` (channels() values, normalised), and the rays cast to `rays`. The
  // path is a function of the receiver and of stream and index. Stops early, with a value of no use, if cancelled.
  void AddPath(const Start& start, const SampleStream& stream, std::uint32_t index, const Cancellation& cancellation,
               std::span<double> irradiance, double& rays) const;

 private:
  template <int kChannels>
  friend class PathWalk;

  // What a path needs of a curve.
  struct Surface {
    Spectrum reflectance;
    Spectrum front_radiance;
    Spectrum back_radiance;
    // Of its front in scatterings_, the back's follows; kLambertian if it is Lambertian, or black.
    std::uint32_t scattering = kLambertian;
  };
  static constexpr std::uint32_t kLambertian = 0xffffffff;

  // Whether it is certain that nothing is above the horizon of a vertex that the sky lights.
  bool SkyIsOpen(const Vertex& vertex) const;
  std::uint32_t MostBounces() const { return options_.max_bounces.value_or(std::numeric_limits<std::uint32_t>::max()); }

  std::shared_ptr<const RayCaster> caster_;
  const Scene& scene_;
  PathTracingOptions options_;
  int channels_;
  std::vector<ElementId> emitting_;
  EmitterSampler emitters_;
  EmitterSights sights_;
  LightSampler lights_;
  ChainLights chains_;
  std::vector<Surface> surfaces_;  // By curve.
  std::vector<Scattering> scatterings_;
  double most_compression_ = 1;  // Of radiance, by one border.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_PATH_TRACING_PATH_TRACER_H_
