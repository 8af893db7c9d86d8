// SPDX-License-Identifier: Apache-2.0
#include "core/plane/chains/chain.h"

#include <numbers>
#include <variant>

namespace flatlight {
namespace {

// Share of a spot's intensity that goes along a direction, as PointLight::Share says it: smoothstep of the angle.
template <std::size_t n>
Series<n> ShareOf(const PointLight& light, const VectorSeries<n>& direction) {
  Series<n> share = Series<n>::Constant(light.Share(direction.Value()));
  if (light.cone_angle >= std::numbers::pi || n == 1) return share;
  // dt/du of t = (edge - angle)/(edge - cone); the angle grows by Cross(d, d') to the side where d lies.
  const double t0 = AngleOf(Dot(light.axis, direction.Value()), std::abs(Cross(light.axis, direction.Value())));
  if (t0 <= light.cone_angle || t0 >= light.edge_angle) return share;
  const double side = Cross(light.axis, direction.Value()) < 0 ? -1 : 1;
  const Series<n> turn = Cross(direction, Derived(direction));
  Series<n> t;
  const double width = light.edge_angle - light.cone_angle;
  t[0] = (light.edge_angle - t0) / width;
  for (std::size_t k = 1; k < n; ++k) t[k] = -side * turn[k - 1] / (static_cast<double>(k) * width);
  return t * t * (Series<n>::Constant(3) - 2.0 * t);
}

// Light before the first link, at the place u on it.
template <std::size_t n>
std::optional<ChainRays<n>> Begin(const Light& light, const Element& first, double u) {
  const VectorSeries<n> place = PlaceOn<n>(first, u);
  ChainRays<n> rays;
  const auto* point = std::get_if<PointLight>(&light.kind);
  if (point == nullptr) {
    const auto& directional = std::get<DirectionalLight>(light.kind);
    rays.ray = {place, VectorSeries<n>::Constant(directional.direction)};
    rays.flux = Cross(rays.ray.direction, Derived(place));
    rays.colour = directional.irradiance;
  } else {
    const VectorSeries<n> from = VectorSeries<n>::Constant(point->position - Point2{});
    const VectorSeries<n> way = place - from;
    const Series<n> squared = Dot(way, way);
    if (!(squared[0] > 0)) return std::nullopt;
    rays.ray = {from, Normalized(way)};
    rays.flux = ShareOf(*point, rays.ray.direction) * (Cross(way, Derived(place)) / squared);
    rays.colour = point->intensity;
  }
  if (rays.flux[0] < 0) rays.flux = -1.0 * rays.flux;
  return rays;
}

template <std::size_t n>
std::optional<ChainRays<n>> Follow(const Scene& scene, const Chain& chain, double u, bool turns_at_last,
                                   std::vector<SurfacePoint>* places) {
  const Element& first = scene.element(chain.links[0].element);
  std::optional<ChainRays<n>> rays = Begin<n>(*chain.light, first, u);
  if (!rays) return std::nullopt;
  for (std::size_t i = 0; i < chain.links.size(); ++i) {
    const ChainLink& link = chain.links[i];
    const bool last = i + 1 == chain.links.size();
    if (last && !turns_at_last) return rays;
    if (i == 0) {
      rays->ray.from = PlaceOn<n>(first, u);
    } else {
      const Element& element = scene.element(link.element);
      const bool own = element.carrier == scene.element(chain.links[i - 1].element).carrier;
      const std::optional<Series<n>> distance = DistanceTo(element, rays->ray, link.far, own);
      if (!distance) return std::nullopt;
      rays->ray.from = rays->ray.from + *distance * rays->ray.direction;
    }
    if (places != nullptr) places->push_back({Point2{} + rays->ray.from.Value(), link.element});
    if (!TurnAt(scene, link, *rays)) return std::nullopt;
  }
  return rays;
}

}  // namespace

template <std::size_t n>
bool TurnAt(const Scene& scene, const ChainLink& link, ChainRays<n>& rays) {
  const Element& element = scene.element(link.element);
  const Curve& curve = scene.curve(element.curve);
  VectorSeries<n> normal = FrontOn(element, rays.ray.from);
  Series<n> cosine = -1.0 * Dot(normal, rays.ray.direction);
  const bool front = cosine[0] > 0;
  if (!front) normal = -1.0 * normal, cosine = -1.0 * cosine;
  Series<n> reflected = Series<n>::Constant(1);
  if (const auto* border = std::get_if<Dielectric>(&curve.material)) {
    const double ratio = front ? border->ior : 1 / border->ior;
    const VectorSeries<n> tangent = Right(normal);
    const Series<n> sine = (1 / ratio) * Dot(tangent, rays.ray.direction);
    const Series<n> square = Series<n>::Constant(1) - sine * sine;
    if (square[0] > 0) {
      // Fresnel's equations for unpolarised light, as SplitAtBorder has them.
      const Series<n> behind = Sqrt(square);
      const Series<n> parallel = (ratio * cosine - behind) / (ratio * cosine + behind);
      const Series<n> perpendicular = (cosine - ratio * behind) / (cosine + ratio * behind);
      reflected = 0.5 * (parallel * parallel + perpendicular * perpendicular);
      if (link.crosses) {
        rays.ray.direction = sine * tangent - behind * normal;
        rays.flux = (Series<n>::Constant(1) - reflected) * rays.flux;
        return true;
      }
    }
  }
  if (link.crosses) return false;
  rays.ray.direction = rays.ray.direction + (2.0 * cosine) * normal;
  rays.flux = reflected * rays.flux;
  rays.colour = rays.colour * curve.reflectance;
  return true;
}

template <std::size_t n>
std::optional<ChainRays<n>> FollowChain(const Scene& scene, const Chain& chain, double u,
                                        std::vector<SurfacePoint>* places) {
  return Follow<n>(scene, chain, u, true, places);
}

template <std::size_t n>
std::optional<ChainRays<n>> FollowChainToLast(const Scene& scene, const Chain& chain, double u) {
  return Follow<n>(scene, chain, u, false, nullptr);
}

template bool TurnAt(const Scene&, const ChainLink&, ChainRays<1>&);
template bool TurnAt(const Scene&, const ChainLink&, ChainRays<2>&);
template bool TurnAt(const Scene&, const ChainLink&, ChainRays<3>&);
template bool TurnAt(const Scene&, const ChainLink&, ChainRays<4>&);
template std::optional<ChainRays<2>> FollowChain(const Scene&, const Chain&, double, std::vector<SurfacePoint>*);
template std::optional<ChainRays<4>> FollowChain(const Scene&, const Chain&, double, std::vector<SurfacePoint>*);
template std::optional<ChainRays<2>> FollowChainToLast(const Scene&, const Chain&, double);

}  // namespace flatlight
