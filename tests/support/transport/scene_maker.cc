// SPDX-License-Identifier: Apache-2.0
#include "tests/support/transport/scene_maker.h"

#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <utility>

namespace flatlight {

void SceneMaker::AddCurve(CurveDescription curve, const Look& look) {
  curve.material = curve.name + " material";
  MaterialKind kind = look.material;
  if (std::holds_alternative<std::monostate>(kind)) kind = LambertianDescription{look.reflectance};
  description_.materials.push_back({curve.material, std::move(kind)});
  if (!look.radiance.empty()) curve.emission = EmissionDescription{look.radiance, look.two_sided};
  description_.curves.push_back(std::move(curve));
}

SceneMaker& SceneMaker::Segment(const std::string& name, Point2 a, Point2 b, const Look& look) {
  CurveDescription curve;
  curve.name = name;
  curve.shape = SegmentDescription{a, b};
  AddCurve(std::move(curve), look);
  return *this;
}

SceneMaker& SceneMaker::Polyline(const std::string& name, std::vector<Point2> points, bool closed, const Look& look) {
  CurveDescription curve;
  curve.name = name;
  curve.shape = PolylineDescription{std::move(points), closed};
  AddCurve(std::move(curve), look);
  return *this;
}

SceneMaker& SceneMaker::Arc(const std::string& name, const ArcDescription& arc, const Look& look) {
  CurveDescription curve;
  curve.name = name;
  curve.shape = arc;
  AddCurve(std::move(curve), look);
  return *this;
}

SceneMaker& SceneMaker::Bezier(const std::string& name, const BezierDescription& bezier, const Look& look) {
  CurveDescription curve;
  curve.name = name;
  curve.shape = bezier;
  AddCurve(std::move(curve), look);
  return *this;
}

SceneMaker& SceneMaker::Light(LightKind light) {
  description_.lights.push_back({"light " + std::to_string(description_.lights.size()), std::move(light)});
  return *this;
}

SceneMaker& SceneMaker::Environment(SpectrumValues radiance) {
  description_.environment = EnvironmentDescription{std::move(radiance)};
  return *this;
}

SceneMaker& SceneMaker::Probe(const std::string& curve, std::uint32_t count, Side side) {
  ProbeDescription probe;
  probe.name = "probe " + std::to_string(description_.probes.size());
  probe.curve = curve;
  probe.count = count;
  probe.side = side;
  description_.probes.push_back(std::move(probe));
  return *this;
}

SceneMaker& SceneMaker::PointProbe(Point2 position, Vector2 normal) {
  ProbeDescription probe;
  probe.name = "probe " + std::to_string(description_.probes.size());
  probe.points = {{position, normal}};
  description_.probes.push_back(std::move(probe));
  return *this;
}

SceneMaker& SceneMaker::Picture(Point2 min, Point2 max, std::uint32_t width, std::uint32_t height) {
  ProbeDescription probe;
  probe.name = "picture" + std::to_string(description_.probes.size());
  probe.fluence = FluenceDescription{min, max, width, height};
  description_.probes.push_back(std::move(probe));
  return *this;
}

SceneMaker& SceneMaker::Camera(Point2 position, Point2 target, double field_of_view, std::uint32_t width,
                               std::optional<Vector2> up) {
  ProbeDescription probe;
  probe.name = "camera" + std::to_string(description_.probes.size());
  probe.camera = CameraDescription{position, target, up, field_of_view, width};
  description_.probes.push_back(std::move(probe));
  return *this;
}

std::shared_ptr<const Scene> SceneMaker::Build() const {
  SceneDescription description = description_;
  if (description.name.empty()) description.name = "test";
  Diagnostics diagnostics;
  std::shared_ptr<const Scene> scene = BuildScene(description, diagnostics);
  for (const Diagnostic& diagnostic : diagnostics.kept()) {
    std::fprintf(stderr, "test scene: %s: %s\n", diagnostic.path.c_str(), diagnostic.message.c_str());
  }
  if (scene == nullptr) std::abort();
  return scene;
}

SceneMaker SquareRoom(const Look& look, std::uint32_t points_per_wall) {
  SceneMaker maker;
  maker.Segment("floor", {-1, -1}, {1, -1}, look);
  maker.Segment("right", {1, -1}, {1, 1}, look);
  maker.Segment("ceiling", {1, 1}, {-1, 1}, look);
  maker.Segment("left", {-1, 1}, {-1, -1}, look);
  for (const char* wall : {"floor", "right", "ceiling", "left"}) maker.Probe(wall, points_per_wall);
  return maker;
}

SceneMaker UnitLight() {
  SceneMaker maker;
  maker.Segment("floor", {0, 0}, {1, 0});
  maker.Segment("light", {1, 1}, {0, 1}, {.radiance = {1}});
  return maker;
}

SceneMaker RoomOfAllMaterials() {
  constexpr double kFullTurn = 2 * std::numbers::pi;
  SceneMaker maker;
  maker.Polyline("room", {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, true, {.reflectance = {0.5, 0.6, 0.7}})
      .Probe("room", 24);
  maker.Arc("lamp", {{-0.5, 0.5}, 0.25, 0, -kFullTurn}, {.radiance = {4, 3, 2}});
  maker.Arc("ball", {{0.3, 0.3}, 0.2, 0, -kFullTurn}, {.material = DielectricDescription{1.5}});
  maker.Segment("gloss", {0.95, 0.9}, {0.95, -0.9}, {.material = PhongDescription{{0.8}, 20}});
  maker.Segment("metal", {0.9, -0.95}, {-0.9, -0.95}, {.material = ConductorDescription{{0.9}, 0.4}});
  maker.Segment("mirror", {-0.95, -0.3}, {-0.95, 0.3}, {.material = MirrorDescription{{0.9}}});
  return maker;
}

SceneMaker FurnishedRoom(bool grey, std::uint32_t points_per_wall) {
  const auto color = [grey](double r, double g, double b) {
    return grey ? SpectrumValues{r} : SpectrumValues{r, g, b};
  };
  SceneMaker maker;
  maker.Segment("floor", {0, 0}, {4, 0}, {.reflectance = color(0.5, 0.5, 0.5)});
  maker.Segment("right", {4, 0}, {4, 3}, {.reflectance = color(0.7, 0.2, 0.2)});
  maker.Segment("ceiling", {4, 3}, {0, 3}, {.reflectance = color(0.8, 0.8, 0.8)});
  maker.Segment("left", {0, 3}, {0, 0}, {.reflectance = color(0.2, 0.7, 0.3)});
  maker.Segment("lamp", {2.5, 2.9}, {1.5, 2.9}, {.reflectance = {0.3}, .radiance = color(5, 4, 3)});
  maker.Arc("bulb", {{0.7, 0.9}, 0.2, 0, -6.283185307179586}, {.reflectance = {0.1}, .radiance = color(1, 1, 2)});
  maker.Arc("disc", {{2.8, 0.8}, 0.4, 0, -6.283185307179586}, {.reflectance = {0.6}});
  maker.Segment("shelf", {1, 1.5}, {2, 1.6}, {.reflectance = {0.4}});
  for (const char* wall : {"floor", "right", "disc", "shelf"}) maker.Probe(wall, points_per_wall);
  return maker;
}

}  // namespace flatlight
