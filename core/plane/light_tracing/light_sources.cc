// SPDX-License-Identifier: Apache-2.0
#include "core/plane/light_tracing/light_sources.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math/trig.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;
// The circle is a little larger than what it encloses, so that nothing begins on a curve.
constexpr double kSpare = 1 + 1e-6;

Vector2 Turned(Vector2 v, double angle) {
  const SinCosValue turn = SinCos(angle);
  return {v.x * turn.cos - v.y * turn.sin, v.x * turn.sin + v.y * turn.cos};
}

// Density proportional to the cosine.
Vector2 CosineDirection(Vector2 normal, double v) {
  const double sine = 2 * v - 1;
  return sine * Right(normal) + std::sqrt((1 - sine) * (1 + sine)) * normal;
}

}  // namespace

LightSources::LightSources(const Scene& scene, const Box& seen) : scene_(scene) {
  Box all = seen;
  for (const Element& element : scene.elements()) {
    const Box box = BoxOf(element, 0);
    all.Add(box.low), all.Add(box.high);
  }
  center_ = all.low + 0.5 * (all.high - all.low);
  radius_ = 0.5 * kSpare * Length(all.high - all.low);
  for (std::size_t e = 0; e < scene.elements().size(); ++e) {
    const ElementId id = static_cast<ElementId>(e);
    const Curve& curve = scene.curve_of(id);
    for (const Side side : {Side::kFront, Side::kBack}) {
      Add({CurveSide{id, side}, 2 * scene.element(id).length * curve.EmittedRadiance(side)});
    }
  }
  for (const Light& light : scene.lights()) {
    if (const auto* point = std::get_if<PointLight>(&light.kind)) {
      Add({point, (point->cone_angle + point->edge_angle) * point->intensity});
    } else {
      const auto& directional = std::get<DirectionalLight>(light.kind);
      Add({&directional, 2 * radius_ * directional.irradiance});
    }
  }
  Add({Sky{}, 2 * kFullTurn * radius_ * scene.environment()});
}

void LightSources::Add(Source source) {
  if (source.flux.IsBlack()) return;
  source.end = (sources_.empty() ? 0 : sources_.back().end) + source.flux.Max();
  flux_ = flux_ + source.flux;
  sources_.push_back(source);
}

EmittedRay LightSources::Emit(double u, double v) const {
  const double target = u * sources_.back().end;
  const auto source = std::upper_bound(sources_.begin(), sources_.end() - 1, target,
                                       [](double t, const Source& s) { return t < s.end; });
  const double begin = source == sources_.begin() ? 0 : std::prev(source)->end;
  const double place = std::clamp((target - begin) / (source->end - begin), 0.0, 1.0);
  EmittedRay ray;
  ray.flux = sources_.back().end / (source->end - begin) * source->flux;
  if (const auto* curve = std::get_if<CurveSide>(&source->kind)) {
    const ElementFrame frame = FrameAt(scene_.element(curve->element), place);
    ray.from = {frame.position, curve->element};
    ray.direction = CosineDirection(curve->side == Side::kFront ? frame.normal : -frame.normal, v);
  } else if (const auto* const* point = std::get_if<const PointLight*>(&source->kind)) {
    const PointLight& light = **point;
    ray.has_surface = false;
    ray.from.position = light.position;
    if (light.cone_angle >= std::numbers::pi) {
      ray.direction = Turned({1, 0}, kFullTurn * v);
    } else {
      // Evenly over all angles that get light.
      ray.direction = Turned(light.axis, (2 * v - 1) * light.edge_angle);
      ray.flux = light.Share(ray.direction) * (2 * light.edge_angle / (light.cone_angle + light.edge_angle)) * ray.flux;
    }
  } else if (const auto* const* directional = std::get_if<const DirectionalLight*>(&source->kind)) {
    ray.has_surface = false;
    ray.direction = (*directional)->direction;
    ray.from.position = center_ + radius_ * ((2 * place - 1) * Left(ray.direction) - 2 * ray.direction);
  } else {
    const Vector2 outward = Turned({1, 0}, kFullTurn * place);
    ray.from.position = center_ + radius_ * outward;
    ray.direction = CosineDirection(-outward, v);
  }
  return ray;
}

}  // namespace flatlight
