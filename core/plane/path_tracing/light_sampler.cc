// SPDX-License-Identifier: Apache-2.0
#include "core/plane/path_tracing/light_sampler.h"

#include <variant>

#include "core/math/tolerances.h"

namespace flatlight {

std::optional<IncidentLight> LightSampler::At(const Light& light, const Vertex& vertex) {
  IncidentLight incident;
  if (const auto* point = std::get_if<PointLight>(&light.kind)) {
    const Vector2 toward = point->position - vertex.at.position;
    const double distance = Length(toward);
    if (!(distance > 0)) return std::nullopt;
    incident.direction = toward / distance;
    incident.irradiance = point->Share(-toward) / distance * point->intensity;
  } else {
    const auto& directional = std::get<DirectionalLight>(light.kind);
    incident.direction = -directional.direction;
    incident.irradiance = directional.irradiance;
  }
  incident.cosine = Dot(vertex.normal, incident.direction);
  if (!(incident.cosine > 0) || incident.irradiance.IsBlack()) return std::nullopt;
  return incident;
}

std::optional<IncidentLight> LightSampler::Choose(const Vertex& vertex, double u, const Light*& chosen) const {
  // In two rounds, so that nothing is kept: the sum first, then the light at which u times it is passed.
  const auto weight = [&](const Light& light) {
    const std::optional<IncidentLight> incident = At(light, vertex);
    return incident ? incident->cosine * incident->irradiance.Max() : 0;
  };
  double total = 0;
  for (const Light& light : lights_) total += weight(light);
  if (!(total > 0)) return std::nullopt;
  double sum = 0;
  double chance = 0;
  for (const Light& light : lights_) {
    const double w = weight(light);
    if (w == 0) continue;
    chosen = &light;
    chance = w / total;
    sum += w;
    if (u * total < sum) break;
  }
  std::optional<IncidentLight> incident = At(*chosen, vertex);
  incident->irradiance = (1 / chance) * incident->irradiance;
  return incident;
}

bool LightSampler::Reaches(const Light& light, const Vertex& vertex, const IncidentLight& incident,
                           double& rays) const {
  ++rays;
  if (const auto* point = std::get_if<PointLight>(&light.kind)) {
    return caster_.Visible(vertex.at, {point->position, ElementId::kNone});
  }
  return !caster_.ClosestHit(vertex.at, incident.direction).has_value();
}

Spectrum LightSampler::Rounding(const Vertex& vertex) const {
  Spectrum sum;
  for (const Light& light : lights_) {
    const std::optional<IncidentLight> incident = At(light, vertex);
    if (!incident) continue;
    double relative = 16 * kUnitRoundoff;
    if (const auto* point = std::get_if<PointLight>(&light.kind)) {
      relative += 4 * caster_.scene().coordinate_error() / Length(point->position - vertex.at.position);
    }
    sum = sum + relative * incident->irradiance;
  }
  return sum;
}

}  // namespace flatlight
