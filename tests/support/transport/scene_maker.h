// SPDX-License-Identifier: Apache-2.0
// Small scenes for tests of transport.
#ifndef FLATLIGHT_TESTS_SUPPORT_TRANSPORT_SCENE_MAKER_H_
#define FLATLIGHT_TESTS_SUPPORT_TRANSPORT_SCENE_MAKER_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/math/vec.h"
#include "core/scene/description.h"
#include "core/scene/scene.h"

namespace flatlight {

using MaterialKind = decltype(MaterialDescription::kind);
using LightKind = decltype(LightDescription::kind);

// Black and dark unless said otherwise.
struct Look {
  SpectrumValues reflectance = {0};
  SpectrumValues radiance = {};  // Empty: does not emit.
  bool two_sided = false;
  MaterialKind material = {};  // Given: in place of Lambertian reflectance.
};

// Collects curves and probes; Build stops the program if they make no valid scene. Each curve has a material of its
// own.
class SceneMaker {
 public:
  // The front is on the left of a -> b.
  SceneMaker& Segment(const std::string& name, Point2 a, Point2 b, const Look& look = {});
  SceneMaker& Polyline(const std::string& name, std::vector<Point2> points, bool closed, const Look& look = {});
  SceneMaker& Arc(const std::string& name, const ArcDescription& arc, const Look& look = {});
  SceneMaker& Bezier(const std::string& name, const BezierDescription& bezier, const Look& look = {});
  SceneMaker& Light(LightKind light);
  SceneMaker& Environment(SpectrumValues radiance);
  SceneMaker& Probe(const std::string& curve, std::uint32_t count, Side side = Side::kFront);
  SceneMaker& PointProbe(Point2 position, Vector2 normal);
  SceneMaker& Picture(Point2 min, Point2 max, std::uint32_t width, std::uint32_t height);

  SceneMaker& Camera(Point2 position, Point2 target, double field_of_view, std::uint32_t width,
                     std::optional<Vector2> up = {});

  const SceneDescription& description() const { return description_; }
  std::shared_ptr<const Scene> Build() const;

 private:
  void AddCurve(CurveDescription curve, const Look& look);

  SceneDescription description_;
};

// A square room of side 2 around the origin, walls alike, their fronts inside; probes on all four walls.
SceneMaker SquareRoom(const Look& look, std::uint32_t points_per_wall);

// A floor from (0,0) to (1,0), unit light of radiance 1 above it at height 1, facing down; black. (THEORY 16)
SceneMaker UnitLight();

// A coloured room with a round lamp, a ball of glass, and gloss, metal and a mirror before its walls, which have
// probes.
SceneMaker RoomOfAllMaterials();

// Rooms with everything in them: a box with coloured walls, two lamps, a disc and a blocker.
SceneMaker FurnishedRoom(bool grey, std::uint32_t points_per_wall);

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_SUPPORT_TRANSPORT_SCENE_MAKER_H_
