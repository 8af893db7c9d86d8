// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_LIGHT_TRACING_LIGHT_SOURCES_H_
#define FLATLIGHT_CORE_PLANE_LIGHT_TRACING_LIGHT_SOURCES_H_

#include <cstdint>
#include <variant>
#include <vector>

#include "core/plane/box.h"
#include "core/plane/ray_caster.h"
#include "core/scene/scene.h"

namespace flatlight {

// Light that leaves a source.
struct EmittedRay {
  SurfacePoint from;
  Vector2 direction;        // Unit.
  Spectrum flux;            // Over the density: its mean over all rays is the flux of all sources. Normalised.
  bool has_surface = true;  // False for lights that no ray meets.
};

// All that shines in a scene, chosen by flux: sides of curves, lights, and the sky, whose light comes from a circle
// around all that matters.
class LightSources {
 public:
  // `seen`: what the light is wanted in, beside all curves.
  LightSources(const Scene& scene, const Box& seen);

  // Of all sources: the sum of their flux, by channel.
  const Spectrum& flux() const { return flux_; }
  bool empty() const { return sources_.empty(); }

  // By two numbers in [0, 1): the first chooses source and place, the second the direction.
  EmittedRay Emit(double u, double v) const;

 private:
  struct CurveSide {
    ElementId element;
    Side side;
  };
  struct Sky {};
  struct Source {
    std::variant<CurveSide, const PointLight*, const DirectionalLight*, Sky> kind;
    Spectrum flux;
    double end = 0;  // Sum of the brightness up to and with this one.
  };
  void Add(Source source);

  const Scene& scene_;
  Point2 center_;  // Of the circle around everything.
  double radius_ = 0;
  Spectrum flux_;
  std::vector<Source> sources_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_LIGHT_TRACING_LIGHT_SOURCES_H_
