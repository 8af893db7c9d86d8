// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/light_scenes.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "tests/bench/random_scenes.h"

namespace flatlight {
namespace {

SceneDescription BlackScene(const char* name) {
  SceneDescription scene;
  scene.name = name;
  scene.materials = {{"black", LambertianDescription{{0}}}};
  return scene;
}

void Add(SceneDescription& scene, decltype(CurveDescription::shape) shape, double radiance) {
  CurveDescription curve;
  curve.name = "curve " + std::to_string(scene.curves.size());
  curve.shape = std::move(shape);
  curve.material = "black";
  if (radiance > 0) curve.emission = EmissionDescription{{radiance}};
  scene.curves.push_back(std::move(curve));
}

void AddCurveProbe(SceneDescription& scene, std::size_t curve, std::uint32_t count) {
  ProbeDescription probe;
  probe.name = "probe " + std::to_string(scene.probes.size());
  probe.curve = scene.curves[curve].name;
  probe.count = count;
  scene.probes.push_back(std::move(probe));
}

Vector2 Direction(RandomNumbers& random) {
  const double angle = 2 * std::numbers::pi * random.Next();
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace

SceneDescription ScatteredCurves(int count, double length, bool arcs, Shining shining, std::uint32_t points) {
  SceneDescription scene = BlackScene("scattered curves");
  Add(scene, SegmentDescription{{0, 0}, {1, 0}}, 0);
  Add(scene, SegmentDescription{{1, 1}, {0, 1}}, 1);
  RandomNumbers random(1);
  for (int i = 0; i < count; ++i) {
    const Point2 middle{random.Next(), 0.05 + 0.9 * random.Next()};
    const Vector2 along = Direction(random);
    const double radiance = shining == Shining::kAll ? 0.1 + random.Next() : 0;
    if (arcs) {
      const double sweep = (random.Next() < 0.5 ? 1 : -1) * std::numbers::pi;
      Add(scene, ArcDescription{middle, 0.5 * length, 2 * std::numbers::pi * random.Next(), sweep}, radiance);
    } else {
      Add(scene, SegmentDescription{middle - 0.5 * length * along, middle + 0.5 * length * along}, radiance);
    }
  }
  AddCurveProbe(scene, 0, points);
  for (std::uint32_t i = 0; i < points; ++i)
    AddCurveProbe(scene, 2 + static_cast<std::size_t>(random.Next() * count), 1);
  ProbeDescription free;
  free.name = "free";
  for (std::uint32_t i = 0; i < points; ++i)
    free.points.push_back({{random.Next(), 0.05 + 0.9 * random.Next()}, Direction(random)});
  scene.probes.push_back(free);
  return scene;
}

SceneDescription Town(int houses_a_side, std::uint32_t points) {
  SceneDescription scene = BlackScene("town");
  RandomNumbers random(3);
  const double step = 1.0 / houses_a_side;
  for (int row = 0; row < houses_a_side; ++row) {
    for (int column = 0; column < houses_a_side; ++column) {
      const Point2 low{(column + 0.05 + 0.2 * random.Next()) * step, (row + 0.05 + 0.2 * random.Next()) * step};
      const Point2 high{(column + 0.75 + 0.2 * random.Next()) * step, (row + 0.75 + 0.2 * random.Next()) * step};
      Add(scene, PolylineDescription{{low, {low.x, high.y}, high, {high.x, low.y}}, true}, random.Next());
    }
  }
  ProbeDescription free;
  free.name = "streets";
  for (std::uint32_t i = 0; i < points; ++i) {
    const double crossing = std::floor(random.Next() * (houses_a_side - 1)) + 1;
    free.points.push_back({{crossing * step, random.Next()}, Direction(random)});
  }
  scene.probes.push_back(free);
  return scene;
}

SceneDescription Passage(int rooms, std::uint32_t points) {
  SceneDescription scene = BlackScene("passage");
  RandomNumbers random(4);
  const double width = 1.0 / rooms;
  Add(scene, SegmentDescription{{0, 0}, {1, 0}}, 0);
  Add(scene, SegmentDescription{{1, 0.1}, {0, 0.1}}, 1);
  for (int room = 0; room <= rooms; ++room) {
    const double x = room * width, door = 0.02 + 0.05 * random.Next();
    Add(scene, SegmentDescription{{x, 0}, {x, door}}, 0.1);
    Add(scene, SegmentDescription{{x, door + 0.01}, {x, 0.1}}, 0.1);
    for (int chair = 0; chair < 20 && room < rooms; ++chair) {
      const Point2 middle{x + width * random.Next(), 0.1 * random.Next()};
      const Vector2 half = 0.1 * width * Direction(random);
      Add(scene, SegmentDescription{middle - half, middle + half}, random.Next());
    }
  }
  AddCurveProbe(scene, 0, points);
  return scene;
}

}  // namespace flatlight
