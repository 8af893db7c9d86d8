// SPDX-License-Identifier: Apache-2.0
// Scenes of random curves.
#ifndef FLATLIGHT_TESTS_CORE_PLANE_RANDOM_CURVES_H_
#define FLATLIGHT_TESTS_CORE_PLANE_RANDOM_CURVES_H_

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <variant>

#include "core/math/vec.h"
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

// A room, so that edits inside leave its extent, and with it all other coordinates, as they are.
inline SceneDescription Room(Random& random, int count, double size) {
  SceneDescription description;
  AddCurve(description, PolylineDescription{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, true});
  for (int i = 0; i < count; ++i) {
    const Point2 a{random.Uniform(-0.9, 0.9), random.Uniform(-0.9, 0.9)};
    if (i % 5 == 0) {
      AddCurve(description, ArcDescription{a, 0.5 * size, random.Uniform(-3, 3), 1.2});
    } else {
      AddCurve(description, SegmentDescription{a, a + size * random.Direction()});
    }
  }
  return description;
}

inline void Move(CurveDescription& curve, Vector2 by) {
  if (auto* segment = std::get_if<SegmentDescription>(&curve.shape)) {
    segment->a = segment->a + by, segment->b = segment->b + by;
  } else if (auto* arc = std::get_if<ArcDescription>(&curve.shape)) {
    arc->center = arc->center + by;
  }
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

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_CORE_PLANE_RANDOM_CURVES_H_
