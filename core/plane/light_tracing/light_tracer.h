// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_LIGHT_TRACING_LIGHT_TRACER_H_
#define FLATLIGHT_CORE_PLANE_LIGHT_TRACING_LIGHT_TRACER_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/plane/light_tracing/fluence_image.h"
#include "core/plane/light_tracing/light_sources.h"
#include "core/plane/materials/scattering.h"
#include "core/plane/ray_caster.h"
#include "core/sampling/sample_stream.h"
#include "core/scene/scene.h"

namespace flatlight {

// A straight stretch of a path of light.
struct LightStep {
  const EmittedRay& emitted;  // Of the path.
  const SurfacePoint& from;
  Vector2 direction;
  const std::optional<Hit>& hit;  // Absent: it goes on for ever.
  const Spectrum& flux;           // Its mean over all paths is the flux of all sources. Normalised.
  std::uint32_t depth;            // Reflections and refractions before.
};

// Light followed from its sources: every way of a path through an image is light in it. Unbiased, caustics included,
// for a pixel is met by light as it is: nothing is asked from the other side. Paths go on with the chance with which
// light is reflected, so that all that are left carry alike much.
class LightTracer {
 public:
  // `seen`: encloses the images. max_bounces: reflections and refractions before light counts no more; absent: all.
  // `least_share`, in (0, 1]: of the flux a path began with; below it, a path goes on by roulette.
  LightTracer(std::shared_ptr<const RayCaster> caster, const Box& seen, std::optional<std::uint32_t> max_bounces,
              double least_share = 1);

  const LightSources& sources() const { return sources_; }

  // Adds path `index` of a stream to all images; its mean is the fluence of the scene. Requires a source. Returns the
  // rays cast.
  double AddPath(const SampleStream& stream, std::uint32_t index, std::span<FluenceImage> images) const;

  // Calls visit(LightStep) for all that path `index` of a stream goes through. Requires a source. Returns the rays
  // cast.
  template <typename Visit>
  double Follow(const SampleStream& stream, std::uint32_t index, Visit visit) const {
    const SamplePair start = stream.Pair(index, 0);
    const EmittedRay emitted = sources_.Emit(start.u, start.v);
    SurfacePoint at = emitted.from;
    const double least_flux = least_share_ * emitted.flux.Max();
    Vector2 direction = emitted.direction;
    Spectrum flux = emitted.flux;
    double rays = 0;
    for (std::uint32_t depth = 0; !flux.IsBlack(); ++depth) {
      const std::optional<Hit> hit = caster_->ClosestHit(at, direction);
      ++rays;
      visit(LightStep{emitted, at, direction, hit, flux, depth});
      if (!hit || depth == most_bounces_) break;
      if (!Scatter(*hit, stream, index, depth, least_flux, direction, flux)) break;
      at = {hit->position, hit->element};
    }
    return rays;
  }

 private:
  // Changes a path's flux and direction where it meets a curve. False if it ends there.
  bool Scatter(const Hit& hit, const SampleStream& stream, std::uint32_t index, std::uint32_t depth, double least_flux,
               Vector2& direction, Spectrum& flux) const;

  std::shared_ptr<const RayCaster> caster_;
  const Scene& scene_;
  std::uint32_t most_bounces_;
  double least_share_;
  LightSources sources_;
  double far_;                           // Beyond everything.
  std::vector<Scattering> scatterings_;  // By curve, front and back.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_LIGHT_TRACING_LIGHT_TRACER_H_
