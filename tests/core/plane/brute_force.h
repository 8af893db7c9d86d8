// SPDX-License-Identifier: Apache-2.0
// Scenes of random curves, and the slow, certain way to cast a ray at them.
#ifndef FLATLIGHT_TESTS_CORE_PLANE_BRUTE_FORCE_H_
#define FLATLIGHT_TESTS_CORE_PLANE_BRUTE_FORCE_H_

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <string>

#include "core/math/vec.h"
#include "core/plane/intersect.h"
#include "core/plane/ray_caster.h"
#include "core/scene/description.h"
#include "core/scene/diagnostic.h"
#include "core/scene/scene.h"

namespace flatlight {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double Uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  Point2 Point() { return {Uniform(-1, 1), Uniform(-1, 1)}; }
  Vector2 Direction() {
    const double angle = Uniform(-std::numbers::pi, std::numbers::pi);
    return {std::cos(angle), std::sin(angle)};
  }

 private:
  std::mt19937_64 engine_;
};

template <typename Shape>
void AddCurve(SceneDescription& scene, Shape shape) {
  if (scene.materials.empty()) scene.materials.push_back({"m", LambertianDescription{{0}}});
  scene.curves.push_back({"c" + std::to_string(scene.curves.size()), shape, "m", std::nullopt});
}

// With a probe, as every scene needs one. Null if the description has mistakes.
inline std::shared_ptr<const Scene> BuildWithProbe(SceneDescription description) {
  ProbeDescription probe;
  probe.name = "p";
  probe.points.push_back({{0, 0}, {0, 1}});
  description.probes.push_back(probe);
  Diagnostics diagnostics;
  return BuildScene(description, diagnostics);
}

struct BruteForceHit {
  double distance = std::numeric_limits<double>::infinity();
  std::uint32_t element = 0;
};

// Every element, one by one.
inline BruteForceHit HitByBruteForce(const Scene& scene, const SurfacePoint& from, Vector2 direction) {
  BruteForceHit hit;
  for (std::uint32_t e = 0; e < scene.elements().size(); ++e) {
    const Element& element = scene.elements()[e];
    const bool own = from.element != ElementId::kNone && scene.element(from.element).carrier == element.carrier;
    Crossings crossings;
    if (element.kind == Element::Kind::kSegment) {
      if (!own) crossings = CrossSegment(element, from.position, direction, scene.touch_distance());
    } else {
      crossings = own ? CrossOwnCircle(element, from.position, direction, scene.touch_distance())
                      : CrossArc(element, from.position, direction, scene.touch_distance());
    }
    for (int i = 0; i < crossings.count; ++i)
      if (crossings.t[i] > 0 && crossings.t[i] < hit.distance) hit = {crossings.t[i], e};
  }
  return hit;
}

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_CORE_PLANE_BRUTE_FORCE_H_
