// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/brightest_light.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <variant>

#include "core/plane/intersect.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

// No less than this is the distance of an element. DistanceTo() gives |d + d^2 / (2 r)| of an arc, where d counts from
// its circle outward, or that of an end; and all of the element is within half its length of the middle of its chord.
double LeastDistance(const Element& element, Point2 point) {
  const double x = DistanceTo(element, point);
  if (element.kind == Element::Kind::kSegment) return x;
  const double from_middle = Length(point - (element.a + 0.5 * (element.b - element.a)));
  return std::max(2 * x / (1 + std::sqrt(1 + 2 * x / element.radius)), from_middle - 0.5 * element.length);
}

Spectrum LightsWithin(const Scene& scene, Point2 from, const Element* element) {
  Spectrum sum;
  for (const Light& light : scene.lights()) {
    if (const auto* point = std::get_if<PointLight>(&light.kind)) {
      const double distance = element ? LeastDistance(*element, point->position) : Length(point->position - from);
      sum = sum + (1 / distance) * point->intensity;
    } else {
      sum = sum + std::get<DirectionalLight>(light.kind).irradiance;
    }
  }
  return sum;
}

}  // namespace

Spectrum LightsAt(const Scene& scene, const Receiver& receiver) {
  return LightsWithin(scene, receiver.position + receiver.offset, nullptr);
}

// A ray against the light ends on what emits or on a Lambertian curve, whose radiance is the mean of what it sees. At
// glass it splits into two shares of radiance over index of refraction that together are one; what the index of one
// place may be to another's is no more than all indices' product.
Spectrum BrightestLight(const Scene& scene) {
  Spectrum source = scene.environment(), reflected;
  double indices = 1;
  bool glows = false;
  for (const Curve& curve : scene.curves()) {
    for (int c = 0; c < kMaxChannels; ++c) source[c] = std::max(source[c], curve.radiance[c]);
    if (const auto* glass = std::get_if<Dielectric>(&curve.material)) {
      indices *= std::max(glass->ior, 1 / glass->ior);
      glows |= curve.Emits();
      continue;
    }
    // A ray goes on from mirrors unchanged, unless they emit: then light may add up on its way.
    if (IsSpecular(curve.material) && !curve.Emits()) continue;
    for (int c = 0; c < kMaxChannels; ++c) reflected[c] = std::max(reflected[c], curve.reflectance[c]);
  }
  Spectrum of_lights;
  for (const Element& element : scene.elements()) {
    const Spectrum here = LightsWithin(scene, {}, &element);
    for (int c = 0; c < kMaxChannels; ++c) of_lights[c] = std::max(of_lights[c], here[c]);
  }
  Spectrum brightest;
  for (int c = 0; c < kMaxChannels; ++c) {
    const double share = reflected[c];
    brightest[c] = indices * (source[c] + 0.5 * share * of_lights[c]) / std::max(1 - share, 0.0);
    if (glows || share >= 1) brightest[c] = std::numeric_limits<double>::infinity();
  }
  return brightest;
}

}  // namespace flatlight
