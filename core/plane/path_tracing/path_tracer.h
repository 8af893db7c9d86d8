// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_PATH_TRACING_PATH_TRACER_H_
#define FLATLIGHT_CORE_PLANE_PATH_TRACING_PATH_TRACER_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/execution/cancellation.h"
#include "core/plane/path_tracing/emitter_sampler.h"
#include "core/plane/path_tracing/vertex.h"
#include "core/plane/ray_caster.h"
#include "core/sampling/sample_stream.h"
#include "core/scene/scene.h"

namespace flatlight {

struct PathTracingOptions {
  std::optional<std::uint32_t> max_bounces;  // Reflections between emitter and receiver. Absent: all.
  bool nothing_blocks = false;               // It is certain that no curve stands between emitters and points.
  // Work that a scene may not need. Where they are allowed these change no result.
  bool one_channel = false;            // Allowed if all spectra are grey.
  bool leave_out_shadow_rays = false;  // Allowed if nothing blocks.
  bool end_black_paths = false;        // Ends a path where it meets a black surface.
  bool drop_unseen_emitters = false;   // Allowed if only direct light is wanted.
};

// Irradiance by paths from the receiver. At each vertex the emitters are sampled, and the path goes on in a direction
// with density cos(theta)/2 (sin(theta) uniform); both reach emitters and are combined by the power heuristic (Veach
// 1997, 9.2) with densities per angle. With reflectance rho and Lambertian curves
//   E = (sampled emitters) + w 2 Le(hit) + rho(hit) E(hit, on the side that was hit).
// Russian roulette ends paths of small weight and divides survivors by their chance: no length is too long to count.
class PathTracer {
 public:
  PathTracer(std::shared_ptr<const RayCaster> caster, const PathTracingOptions& options);

  // 1 or 3.
  int channels() const { return channels_; }

  // What the emitters would give the receiver if nothing blocked them, 0 if nothing can block them: the most by which
  // finding a ray blocked or not can change a sample of direct light.
  Spectrum DirectStep(const Receiver& receiver) const;

  // Adds the estimate of one path to `irradiance` (channels() values, normalised), and the rays cast to `rays`. The
  // path is a function of the receiver and of stream and index. Stops early, with a value of no use, if cancelled.
  void AddPath(const Receiver& receiver, const SampleStream& stream, std::uint32_t index,
               const Cancellation& cancellation, std::span<double> irradiance, double& rays) const;

 private:
  // What a path needs of a curve.
  struct Surface {
    Spectrum reflectance;
    Spectrum front_radiance;
    Spectrum back_radiance;
  };

  template <int kChannels>
  void AddPathOf(const Receiver& receiver, const SampleStream& stream, std::uint32_t index,
                 const Cancellation& cancellation, std::span<double> irradiance, double& rays) const;

  std::shared_ptr<const RayCaster> caster_;
  const Scene& scene_;
  PathTracingOptions options_;
  int channels_;
  EmitterSampler emitters_;
  std::vector<Surface> surfaces_;  // By curve.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_PATH_TRACING_PATH_TRACER_H_
