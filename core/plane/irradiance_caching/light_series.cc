// SPDX-License-Identifier: Apache-2.0
#include "core/plane/irradiance_caching/light_series.h"

#include <cmath>
#include <cstddef>
#include <variant>

#include "core/math/trig.h"

namespace flatlight {
namespace {

// The light's place in the receiver's frame: along the tangent and the normal, t' = kappa n. Up to the third derivative
// on curves whose curvature changes, as SeriesOf in break_series.h.
struct Place {
  ArcSeries tangent, normal, squared;

  Place(Vector2 toward, const Receiver& receiver) {
    tangent[0] = Dot(receiver.tangent, toward), normal[0] = Dot(receiver.normal, toward);
    squared[0] = LengthSquared(toward);
    ArcSeries kappa;
    kappa[0] = receiver.curvature, kappa[1] = receiver.curvature_change, kappa[2] = 0.5 * receiver.curvature_second;
    for (std::size_t k = 0; k + 1 < kRecordOrders; ++k) {
      const double step = 1 / static_cast<double>(k + 1);
      tangent[k + 1] = step * (ArcSeries::Times(kappa, normal, k) - (k == 0 ? 1 : 0));
      normal[k + 1] = -step * ArcSeries::Times(kappa, tangent, k);
      squared[k + 1] = -2 * step * tangent[k];
    }
  }
};

// The share of a spot's intensity that goes to the receiver.
ArcSeries Share(const PointLight& light, Vector2 toward, const Receiver& receiver, const Place& place) {
  ArcSeries share;
  const Vector2 along = -toward;
  const double side = Cross(light.axis, along);
  ArcSeries angle;
  angle[0] = AngleOf(Dot(light.axis, along), std::abs(side));
  if (angle[0] <= light.cone_angle) {
    share[0] = 1;
    return share;
  }
  if (angle[0] >= light.edge_angle) return share;
  // It turns by the receiver's motion across the ray over the distance, and grows away from the axis.
  const double sign = (side < 0 ? -1 : 1) * (Cross(receiver.tangent, receiver.normal) < 0 ? -1 : 1);
  const ArcSeries turn = place.normal / place.squared;
  for (std::size_t k = 0; k + 1 < kRecordOrders; ++k) angle[k + 1] = sign * turn[k] / static_cast<double>(k + 1);
  ArcSeries t = (-1 / (light.edge_angle - light.cone_angle)) * angle;
  t[0] += light.edge_angle / (light.edge_angle - light.cone_angle);
  ArcSeries three;
  three[0] = 3;
  return t * t * (three + -2 * t);
}

}  // namespace

std::optional<ArcSeries> LightSeries(const Light& light, const Receiver& receiver, const RayCaster& caster) {
  const SurfacePoint from = {receiver.position, receiver.element};
  if (const auto* point = std::get_if<PointLight>(&light.kind)) {
    const Vector2 toward = point->position - receiver.position;
    if (!(Dot(receiver.normal, toward) > 0)) return std::nullopt;
    if (!caster.Visible(from, {point->position, ElementId::kNone})) return std::nullopt;
    const Place place(toward, receiver);
    const ArcSeries falloff = place.normal / place.squared;
    const bool spot = point->cone_angle < 0x1.921fb54442d18p+1;
    return spot ? falloff * Share(*point, toward, receiver, place) : falloff;
  }
  const auto& directional = std::get<DirectionalLight>(light.kind);
  const Vector2 toward = -directional.direction;
  if (!(Dot(receiver.normal, toward) > 0)) return std::nullopt;
  if (caster.ClosestHit(from, toward).has_value()) return std::nullopt;
  // cos'' = -kappa^2 cos.
  ArcSeries cosine, sine;
  cosine[0] = Dot(receiver.normal, toward), sine[0] = Dot(receiver.tangent, toward);
  for (std::size_t k = 0; k + 1 < kRecordOrders; ++k) {
    const double step = receiver.curvature / static_cast<double>(k + 1);
    cosine[k + 1] = -step * sine[k];
    sine[k + 1] = step * cosine[k];
  }
  return cosine;
}

}  // namespace flatlight
