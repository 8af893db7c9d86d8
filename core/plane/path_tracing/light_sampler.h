// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_PATH_TRACING_LIGHT_SAMPLER_H_
#define FLATLIGHT_CORE_PLANE_PATH_TRACING_LIGHT_SAMPLER_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "core/plane/chains/incident_light.h"
#include "core/plane/path_tracing/vertex.h"
#include "core/plane/ray_caster.h"
#include "core/scene/scene.h"

namespace flatlight {

// Light of lights without a surface (THEORY 3): of all of them where they are few, else of one that is chosen by the
// irradiance that it would give if nothing blocked.
class LightSampler {
 public:
  static constexpr std::size_t kMostVisited = 4;

  explicit LightSampler(const RayCaster& caster) : caster_(caster), lights_(caster.scene().lights()) {}

  bool empty() const { return lights_.empty(); }

  // Calls visit(IncidentLight) for what comes to the vertex unblocked, weighed such that the sum over all visits has
  // the right mean; `u` in [0, 1) chooses. Counts the rays cast.
  template <typename Visit>
  void VisitUnblocked(const Vertex& vertex, double u, double& rays, Visit visit) const {
    if (lights_.size() <= kMostVisited) {
      for (const Light& light : lights_) {
        const std::optional<IncidentLight> incident = At(light, vertex);
        if (incident && Reaches(light, vertex, *incident, rays)) visit(*incident);
      }
      return;
    }
    const Light* chosen = nullptr;
    const std::optional<IncidentLight> incident = Choose(vertex, u, chosen);
    if (incident && Reaches(*chosen, vertex, *incident, rays)) visit(*incident);
  }

  // The rounding of what comes from all lights.
  Spectrum Rounding(const Vertex& vertex) const;

 private:
  static std::optional<IncidentLight> At(const Light& light, const Vertex& vertex);
  std::optional<IncidentLight> Choose(const Vertex& vertex, double u, const Light*& chosen) const;
  bool Reaches(const Light& light, const Vertex& vertex, const IncidentLight& incident, double& rays) const;

  const RayCaster& caster_;
  const std::vector<Light>& lights_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_PATH_TRACING_LIGHT_SAMPLER_H_
