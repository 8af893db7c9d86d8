// SPDX-License-Identifier: Apache-2.0
// Scenes for the tests of exact light, and its values in world units.
#ifndef FLATLIGHT_TESTS_CORE_PLANE_EXACT_TEST_SCENES_H_
#define FLATLIGHT_TESTS_CORE_PLANE_EXACT_TEST_SCENES_H_

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/plane/bvh.h"
#include "core/plane/exact/exact.h"
#include "core/plane/triangulation/triangulation.h"
#include "core/scene/scene.h"

namespace flatlight {

inline constexpr double kPi = 3.14159265358979323846;

inline SceneDescription EmptyScene() {
  SceneDescription scene;
  scene.materials.push_back({"black", LambertianDescription{{0}}});
  return scene;
}

template <typename Shape>
void AddCurve(SceneDescription& scene, Shape shape, double radiance = 0, bool two_sided = false) {
  CurveDescription curve;
  curve.name = "c" + std::to_string(scene.curves.size());
  curve.shape = shape;
  curve.material = "black";
  if (radiance > 0) curve.emission = EmissionDescription{{radiance}, two_sided};
  scene.curves.push_back(curve);
}

inline void AddProbe(SceneDescription& scene, std::size_t curve, std::uint32_t count, Side side = Side::kFront) {
  ProbeDescription probe;
  probe.name = "p" + std::to_string(scene.probes.size());
  probe.curve = "c" + std::to_string(curve);
  probe.count = count;
  probe.side = side;
  scene.probes.push_back(probe);
}

inline std::shared_ptr<const Scene> Build(const SceneDescription& description) {
  Diagnostics diagnostics;
  auto scene = BuildScene(description, diagnostics);
  for (const Diagnostic& d : diagnostics.kept()) ADD_FAILURE() << d.path << ": " << d.message;
  return scene;
}

// First channel, world units.
struct WorldValue {
  double irradiance, gradient, hessian, irradiance_error, gradient_error, hessian_error;
};

inline std::vector<WorldValue> Solve(const Scene& scene, std::size_t probe, const Triangulation* triangulation) {
  const Bvh bvh(scene);
  ExactSolver solver(scene, bvh, {}, triangulation);
  std::vector<WorldValue> values;
  const double l = scene.frame().radiance_scale, k = scene.frame().scale;
  for (const Receiver& receiver : scene.probes()[probe].receivers) {
    const ExactValue v = solver.Evaluate(receiver);
    values.push_back({v.irradiance[0] * l, v.gradient[0] * l / k, v.hessian[0] * l / k / k, v.irradiance_error[0] * l,
                      v.gradient_error[0] * l / k, v.hessian_error[0] * l / k / k});
  }
  return values;
}

// By the tree; where the scene can be triangulated that must agree.
inline std::vector<WorldValue> Solve(const Scene& scene, std::size_t probe) {
  std::vector<WorldValue> values = Solve(scene, probe, nullptr);
  const auto triangulation = Triangulation::Of(scene);
  if (!triangulation) return values;
  const std::vector<WorldValue> others = Solve(scene, probe, triangulation.get());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const WorldValue &a = values[i], &b = others[i];
    EXPECT_NEAR(a.irradiance, b.irradiance, a.irradiance_error + b.irradiance_error) << "by triangles, point " << i;
    EXPECT_NEAR(a.gradient, b.gradient, a.gradient_error + b.gradient_error) << "by triangles, point " << i;
    EXPECT_NEAR(a.hessian, b.hessian, a.hessian_error + b.hessian_error) << "by triangles, point " << i;
  }
  return values;
}

inline double Uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

inline Point2 RandomPoint(std::mt19937_64& random) { return {Uniform(random, -1, 1), Uniform(random, -1, 1)}; }

inline void AddRandomCurve(SceneDescription& scene, std::mt19937_64& random, bool arcs) {
  const double radiance = random() % 2 == 0 ? Uniform(random, 0.5, 2) : 0;
  const bool two_sided = random() % 3 == 0;
  if (arcs && random() % 2 == 0) {
    const double sweep = (random() % 2 == 0 ? 1 : -1) * (random() % 4 == 0 ? 2 * kPi : Uniform(random, 0.2, 6.2));
    AddCurve(scene, ArcDescription{RandomPoint(random), Uniform(random, 0.05, 0.7), Uniform(random, -7, 7), sweep},
             radiance, two_sided);
  } else {
    const Point2 a = RandomPoint(random);
    const double length = random() % 2 == 0 ? 0.3 : 1.5;
    AddCurve(scene, SegmentDescription{a, a + length * Vector2{Uniform(random, -1, 1), Uniform(random, -1, 1)}},
             radiance, two_sided);
  }
}

inline SceneDescription WithFreePoint(SceneDescription scene, Point2 position) {
  ProbeDescription probe;
  probe.name = "p";
  probe.points.push_back({position, {0, 1}});
  scene.probes.push_back(probe);
  return scene;
}

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_CORE_PLANE_EXACT_TEST_SCENES_H_
