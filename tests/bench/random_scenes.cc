// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/random_scenes.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>

#include "core/scene/diagnostic.h"

namespace flatlight {

SceneDescription RandomSegments(int count, double reflectance, std::uint32_t probe_points) {
  SceneDescription scene;
  scene.name = "random segments";
  scene.materials = {{"grey", LambertianDescription{{reflectance}}}};
  scene.curves.push_back({"floor", SegmentDescription{{0, 0}, {1, 0}}, "grey", std::nullopt});
  scene.curves.push_back({"lamp", SegmentDescription{{1, 1}, {0, 1}}, "grey", EmissionDescription{{1}}});
  RandomNumbers random(1);
  const double length = 0.5 / std::sqrt(count);
  for (int i = 0; i < count; ++i) {
    const Point2 middle{random.Next(), 0.1 + 0.8 * random.Next()};
    const double angle = 2 * std::numbers::pi * random.Next();
    const Vector2 half{0.5 * length * std::cos(angle), 0.5 * length * std::sin(angle)};
    scene.curves.push_back(
        {"segment " + std::to_string(i), SegmentDescription{middle - half, middle + half}, "grey", std::nullopt});
  }
  ProbeDescription probe;
  probe.name = "floor";
  probe.curve = "floor";
  probe.count = probe_points;
  scene.probes.push_back(probe);
  return scene;
}

std::shared_ptr<const Scene> Built(const SceneDescription& description) {
  Diagnostics diagnostics;
  std::shared_ptr<const Scene> scene = BuildScene(description, diagnostics);
  if (!scene) {
    std::fprintf(stderr, "%s: %s\n", diagnostics.kept()[0].path.c_str(), diagnostics.kept()[0].message.c_str());
    std::abort();
  }
  return scene;
}

std::shared_ptr<const Scene> BuiltRandomSegments(int count, double reflectance, std::uint32_t probe_points) {
  return Built(RandomSegments(count, reflectance, probe_points));
}

}  // namespace flatlight
