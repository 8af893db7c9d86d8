// SPDX-License-Identifier: Apache-2.0
#include "core/scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kPi = 3.14159265358979323846;

// A floor, a lamp above it and a round post; a probe on the floor.
SceneDescription GoodScene() {
  SceneDescription scene;
  scene.name = "good";
  scene.materials.push_back({"white", LambertianDescription{{0.8}}});
  scene.curves.push_back({"floor", SegmentDescription{{-2, 0}, {2, 0}}, "white", std::nullopt});
  scene.curves.push_back({"lamp", SegmentDescription{{0.5, 2}, {-0.5, 2}}, "white", EmissionDescription{{5}, false}});
  scene.curves.push_back({"post", ArcDescription{{0.6, 0.7}, 0.2, 0, -2 * kPi}, "white", std::nullopt});
  ProbeDescription probe;
  probe.name = "floor";
  probe.curve = "floor";
  probe.count = 4;
  scene.probes.push_back(probe);
  return scene;
}

std::vector<std::string> Mistakes(const SceneDescription& description) {
  Diagnostics diagnostics;
  const auto scene = BuildScene(description, diagnostics);
  EXPECT_EQ(scene == nullptr, !diagnostics.empty());
  std::vector<std::string> texts;
  for (const Diagnostic& d : diagnostics.kept()) texts.push_back(d.path + " " + d.message);
  return texts;
}

std::shared_ptr<const Scene> Build(const SceneDescription& description) {
  EXPECT_THAT(Mistakes(description), IsEmpty());
  Diagnostics diagnostics;
  return BuildScene(description, diagnostics);
}

TEST(SceneTest, MaterialsAndLightsCountInTheWorldsHash) {
  SceneDescription scene = GoodScene();
  std::set<std::string> hashes{Build(scene)->world_hash()};
  const auto differs = [&] { return hashes.insert(Build(scene)->world_hash()).second; };
  for (const decltype(MaterialDescription::kind)& kind : std::vector<decltype(MaterialDescription::kind)>{
           MirrorDescription{{0.8}}, DielectricDescription{1.5}, DielectricDescription{1.6}, PhongDescription{{0.8}, 2},
           PhongDescription{{0.8}, 3}, ConductorDescription{{0.8}, 0.2}, ConductorDescription{{0.8}, 0.3}}) {
    scene.materials[0].kind = kind;
    EXPECT_TRUE(differs());
  }
  scene.lights.push_back({"bulb", PointLightDescription{{0, 1}, {5}}});
  EXPECT_TRUE(differs());
  scene.lights[0].kind = SpotLightDescription{{0, 1}, {0, -1}, {5}, 0.1, 0.2};
  EXPECT_TRUE(differs());
  scene.lights[0].kind = DirectionalLightDescription{{0, -1}, {5}};
  EXPECT_TRUE(differs());
  scene.environment = EnvironmentDescription{{1}};
  EXPECT_TRUE(differs());
  scene.lights.clear();
  EXPECT_TRUE(differs());
  scene.environment->radiance = {2};
  EXPECT_TRUE(differs());
}

// Every mistake that a description can have, one by one.
TEST(SceneTest, EachMistakeNamesPlaceValueAndWhatIsAllowed) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  struct Case {
    std::function<void(SceneDescription&)> spoil;
    std::string path;
    std::string message;
  };
  const auto segment = [](SceneDescription& s) -> SegmentDescription& {
    return std::get<SegmentDescription>(s.curves[0].shape);
  };
  const auto arc = [](SceneDescription& s) -> ArcDescription& { return std::get<ArcDescription>(s.curves[2].shape); };
  const std::vector<Case> cases = {
      {[&](auto& s) { s.name = std::string(1001, 'x'); }, "name ", "has 1001 bytes; at most 1000 are allowed"},
      {[&](auto& s) { segment(s).a.x = nan; }, "plane.curves[0].segment.a.x ", "is nan"},
      {[&](auto& s) { segment(s).b.y = infinity; }, "plane.curves[0].segment.b.y ", "is inf"},
      {[&](auto& s) { segment(s).b = segment(s).a; }, "plane.curves[0].segment ", "zero length"},
      {[&](auto& s) {
         s.curves[0].shape = PolylineDescription{{{0, 0}}, false};
       },
       "plane.curves[0].polyline.points ", "at least 2"},
      {[&](auto& s) {
         s.curves[0].shape = PolylineDescription{{{0, 0}, {1, 1}, {1, 1}}, false};
       },
       "plane.curves[0].polyline.points[2] ", "neighbours must differ"},
      {[&](auto& s) {
         s.curves[0].shape = PolylineDescription{{{0, 0}, {1, 1}, {0, 0}}, true};
       },
       "plane.curves[0].polyline.points[2] ", "equals the first point"},
      {[&](auto& s) { s.curves[0].shape = std::monostate{}; }, "plane.curves[0] ", "no shape"},
      {[&](auto& s) { arc(s).radius = 0; }, "plane.curves[2].arc.radius ", "is 0; allowed: above 0"},
      {[&](auto& s) { arc(s).radius = -1; }, "plane.curves[2].arc.radius ", "is -1"},
      {[&](auto& s) { arc(s).sweep_angle = 7; }, "plane.curves[2].arc.sweepAngle ", "is 7; allowed: -6.283"},
      {[&](auto& s) { arc(s).sweep_angle = 0; }, "plane.curves[2].arc.sweepAngle ", "is 0"},
      {[&](auto& s) { arc(s).start_angle = 1e7; }, "plane.curves[2].arc.startAngle ",
       "is 1e+07; allowed: -1e+06 to 1e+06"},
      {[&](auto& s) { s.curves[1].material = "glass"; }, "plane.curves[1].material ",
       "\"glass\" is not a material; known: \"white\""},
      {[&](auto& s) { s.curves[1].name = "floor"; }, "plane.curves[1].name ", "plane.curves[0]"},
      {[&](auto& s) { s.curves[1].name = ""; }, "plane.curves[1].name ", "missing or empty"},
      {[&](auto& s) { s.curves[1].emission->radiance = {-1}; }, "plane.curves[1].emission.radiance[0] ",
       "is -1; allowed: 0 to"},
      {[&](auto& s) {
         s.curves[1].emission->radiance = {1, 2};
       },
       "plane.curves[1].emission.radiance ", "has 2 values"},
      {[&](auto& s) {
         s.materials[0].kind = LambertianDescription{{0.2, 1.5, 0}};
       },
       "plane.materials[0].lambertian.reflectance[1] ", "is 1.5; allowed: 0 to 1"},
      {[&](auto& s) { s.materials[0].kind = std::monostate{}; }, "plane.materials[0] ", "no kind"},
      {[&](auto& s) { s.probes.clear(); }, "probes ", "at least one"},
      {[&](auto& s) { s.probes[0].curve = "roof"; }, "probes[0].curve ", "\"roof\" is not a curve"},
      {[&](auto& s) { s.probes[0].count.reset(); }, "probes[0].count ", "missing"},
      {[&](auto& s) { s.probes[0].count = 0; }, "probes[0].count ", "is 0; allowed: 1 to"},
      {[&](auto& s) { s.probes[0].count = 4000000000; }, "probes[0].count ", "is 4000000000"},
      {[&](auto& s) { s.probes[0].from = 1.5; }, "probes[0].from ", "is 1.5; allowed: 0 to 1"},
      {[&](auto& s) { s.probes[0].to = 0; }, "probes[0].to ", "equals from"},
      {[&](auto& s) {
         s.probes[0].points.push_back({{0, 1}, {0, 1}});
       },
       "probes[0] ", "more than one of curve, points, fluence and camera"},
      {[&](auto& s) { s.probes[0].curve.reset(); }, "probes[0] ", "none of curve, points, fluence and camera"},
  };
  for (const Case& c : cases) {
    SceneDescription scene = GoodScene();
    c.spoil(scene);
    EXPECT_THAT(Mistakes(scene), testing::Contains(testing::AllOf(testing::StartsWith(c.path), HasSubstr(c.message))))
        << c.path << c.message;
  }
}

SceneDescription SceneWithPicture(const FluenceDescription& picture) {
  SceneDescription scene = GoodScene();
  scene.probes[0] = ProbeDescription();
  scene.probes[0].name = "light";
  scene.probes[0].fluence = picture;
  return scene;
}

TEST(SceneTest, MistakesInPictures) {
  struct Case {
    FluenceDescription picture;
    std::string message;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Case> cases = {
      {{Point2{0, 0}, Point2{1, 1}, {}, 5}, "probes[0].fluence.width is missing"},
      {{Point2{0, 0}, Point2{1, 1}, 0, 5}, "probes[0].fluence.width is 0; allowed: 1 to 16384"},
      {{Point2{0, 0}, Point2{1, 1}, 5, 16385}, "probes[0].fluence.height is 16385; allowed: 1 to 16384"},
      {{Point2{0, 0}, Point2{1, 1}, 2048, 2048}, "probes have 4194304 pixels; at most 2097152 are allowed"},
      {{Point2{0, 0}, Point2{0, 1}, 5, 5}, "probes[0].fluence.max.x is 0; allowed: above min.x, 0"},
      {{Point2{0, 2}, Point2{1, 1}, 5, 5}, "probes[0].fluence.max.y is 1; allowed: above min.y, 2"},
      {{Point2{0, nan}, Point2{1, 1}, 5, 5}, "probes[0].fluence.min.y is nan"},
      {{Point2{0, 0}, {}, 5, 5}, "probes[0].fluence has min but no max"},
      {{{}, Point2{0, 0}, 5, 5}, "probes[0].fluence has max but no min"},
  };
  for (const Case& c : cases)
    EXPECT_THAT(Mistakes(SceneWithPicture(c.picture)), testing::Contains(HasSubstr(c.message)));
  SceneDescription empty = SceneWithPicture({{}, {}, 5, 5});
  empty.curves.clear();
  EXPECT_THAT(Mistakes(empty), testing::Contains(HasSubstr("no curves to put into the picture")));
}

// The curves of the good scene lie in [-2, 2] x [0, 2].
TEST(SceneTest, APictureOfTheWholeSceneHasAMarginAndSquarePixels) {
  for (const auto& [width, height] : {std::pair{400u, 100u}, {50u, 200u}, {7u, 7u}}) {
    const auto scene = Build(SceneWithPicture({{}, {}, width, height}));
    ASSERT_TRUE(scene->probes()[0].picture.has_value());
    const PixelGrid& grid = *scene->probes()[0].picture;
    const Point2 low = scene->ToWorld(grid.low), high = scene->ToWorld(grid.high);
    EXPECT_NEAR((high.x - low.x) / width, (high.y - low.y) / height, 1e-12);
    EXPECT_NEAR(0.5 * (low.x + high.x), 0, 1e-12);
    EXPECT_NEAR(0.5 * (low.y + high.y), 1, 1e-12);
    EXPECT_NEAR(std::min(high.x - 2, high.y - 2), 0.12, 1e-12) << "one of the sides has just the margin";
    EXPECT_EQ(scene->traits().pixels, std::size_t{width} * height);
    EXPECT_EQ(scene->traits().probe_points, 0u);
  }
}

TEST(SceneTest, PicturesCountInTheProbesHash) {
  std::set<std::string> hashes{Build(GoodScene())->probe_hash()};
  const auto differs = [&](const FluenceDescription& picture) {
    return hashes.insert(Build(SceneWithPicture(picture))->probe_hash()).second;
  };
  EXPECT_TRUE(differs({{}, {}, 5, 6}));
  EXPECT_TRUE(differs({{}, {}, 6, 5}));
  EXPECT_TRUE(differs({Point2{0, 0}, Point2{1, 1}, 5, 6}));
  EXPECT_TRUE(differs({Point2{0, 0}, Point2{1, 1.5}, 5, 6}));
  EXPECT_FALSE(differs({Point2{0, 0}, Point2{1, 1.5}, 5, 6}));
}

SceneDescription SceneWithCamera(const CameraDescription& camera) {
  SceneDescription scene = GoodScene();
  scene.probes[0] = ProbeDescription();
  scene.probes[0].name = "eye";
  scene.probes[0].camera = camera;
  return scene;
}

TEST(SceneTest, MistakesInCameras) {
  struct Case {
    CameraDescription camera;
    std::string message;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Case> cases = {
      {{{0, 1}, {1, 1}, {}, 1, {}}, "probes[0].camera.width is missing"},
      {{{0, 1}, {1, 1}, {}, 1, 0}, "probes[0].camera.width is 0; allowed: 1 to 1000000"},
      {{{0, 1}, {1, 1}, {}, 0, 5}, "probes[0].camera.fieldOfView is 0; allowed: between 0 and pi"},
      {{{0, 1}, {1, 1}, {}, 3.15, 5}, "probes[0].camera.fieldOfView is 3.15"},
      {{{0, 1}, {1, 1}, {}, nan, 5}, "probes[0].camera.fieldOfView is nan"},
      {{{0, 1}, {0, 1}, {}, 1, 5}, "probes[0].camera.target is the camera's position"},
      {{{0, nan}, {0, 1}, {}, 1, 5}, "probes[0].camera.position.y is nan"},
      {{{0, 1}, {2, 1}, Vector2{-3, 0}, 1, 5}, "probes[0].camera.up lies along the line of sight"},
      {{{0, 1}, {2, 1}, Vector2{0, 0}, 1, 5}, "probes[0].camera.up is (0, 0)"},
  };
  for (const Case& c : cases)
    EXPECT_THAT(Mistakes(SceneWithCamera(c.camera)), testing::ElementsAre(HasSubstr(c.message))) << c.message;
  SceneDescription both = SceneWithCamera({{0, 1}, {1, 1}, {}, 1, 5});
  both.probes[0].fluence = FluenceDescription{{}, {}, 5, 5};
  EXPECT_THAT(Mistakes(both), testing::Contains(HasSubstr("more than one of")));
}

// Pixels follow each other without gaps, equally wide on a screen; the line runs from left to right, or toward `up`.
TEST(SceneTest, ACameraIsALineOfPixels) {
  const auto scene = Build(SceneWithCamera({{0.5, 1}, {0.5, 3}, {}, 2, 4}));
  const Probe& camera = scene->probes()[0];
  EXPECT_TRUE(camera.camera);
  EXPECT_EQ(scene->traits().camera_pixels, 4u);
  ASSERT_EQ(camera.receivers.size(), 4u);
  double angle = -1;  // From the line of sight, to the right.
  for (int i = 0; i < 4; ++i) {
    const Receiver& pixel = camera.receivers[static_cast<std::size_t>(i)];
    const double middle = std::atan2(pixel.normal.x, pixel.normal.y);
    EXPECT_NEAR(middle - pixel.half_angle, angle, 1e-14);
    angle = middle + pixel.half_angle;
    EXPECT_NEAR(std::tan(angle), std::tan(1.0) * (i - 1) / 2, 1e-14);
  }
  const auto turned = Build(SceneWithCamera({{0.5, 1}, {0.5, 3}, Vector2{-0.1, 7}, 2, 4}));
  EXPECT_NEAR(turned->probes()[0].receivers[3].normal.x, -camera.receivers[3].normal.x, 1e-15);
}

TEST(SceneTest, CamerasCountInTheProbesHash) {
  std::set<std::string> hashes{Build(GoodScene())->probe_hash()};
  const auto differs = [&](const CameraDescription& camera) {
    return hashes.insert(Build(SceneWithCamera(camera))->probe_hash()).second;
  };
  EXPECT_TRUE(differs({{0, 1}, {1, 1}, {}, 1, 5}));
  EXPECT_TRUE(differs({{0, 2}, {1, 1}, {}, 1, 5}));
  EXPECT_TRUE(differs({{0, 1}, {1, 2}, {}, 1, 5}));
  EXPECT_TRUE(differs({{0, 1}, {1, 1}, Vector2{0, 1}, 1, 5}));
  EXPECT_TRUE(differs({{0, 1}, {1, 1}, {}, 2, 5}));
  EXPECT_TRUE(differs({{0, 1}, {1, 1}, {}, 1, 6}));
  EXPECT_FALSE(differs({{0, 1}, {1, 1}, {}, 1, 6}));
}

TEST(SceneTest, AllMistakesAreReported) {
  SceneDescription scene = GoodScene();
  scene.curves[0].material = "x";
  scene.curves[1].emission->radiance = {-1, 0, -2};
  std::get<ArcDescription>(scene.curves[2].shape).radius = -3;
  scene.probes[0].count = 0;
  EXPECT_THAT(Mistakes(scene), SizeIs(5));
}

TEST(SceneTest, GeometryIsNormalisedWithoutRounding) {
  for (const double scale : {1e-9, 1.0, 1e9}) {
    for (const double shift : {0.0, 1e6}) {
      SceneDescription scene = GoodScene();
      for (CurveDescription& curve : scene.curves) {
        if (auto* s = std::get_if<SegmentDescription>(&curve.shape)) {
          for (Point2* p : {&s->a, &s->b}) *p = {p->x * scale + shift * scale, p->y * scale};
        } else {
          auto& arc = std::get<ArcDescription>(curve.shape);
          arc.center = {arc.center.x * scale + shift * scale, arc.center.y * scale}, arc.radius *= scale;
        }
      }
      const auto built = Build(scene);
      for (const Element& element : built->elements()) {
        EXPECT_LE(std::abs(element.a.x), 1);
        EXPECT_LE(std::abs(element.a.y), 1);
      }
      EXPECT_NEAR(built->curves()[0].length * built->frame().scale, 4 * scale, 1e-9 * scale);
      EXPECT_EQ(std::log2(built->frame().scale), std::floor(std::log2(built->frame().scale)));
    }
  }
}

TEST(SceneTest, ProbePointsFollowTheConventions) {
  SceneDescription description = GoodScene();
  description.probes[0].from = 0.25;
  description.probes[0].side = Side::kBack;
  ProbeDescription round;
  round.name = "post";
  round.curve = "post";
  round.count = 8;
  description.probes.push_back(round);
  const auto scene = Build(description);
  const Receiver& first = scene->probes()[0].receivers[0];
  EXPECT_NEAR(scene->ToWorld(first.position).x, -2 + 4 * (0.25 + 0.75 * 0.125), 1e-15);
  EXPECT_EQ(first.normal, (Vector2{0, -1}));
  EXPECT_EQ(first.tangent, (Vector2{1, 0}));
  EXPECT_NEAR(first.arc_length * scene->frame().scale, 4 * (0.25 + 0.75 * 0.125), 1e-15);
  // The clockwise post faces away from its centre and its tangent turns away from its normal.
  const Receiver& post = scene->probes()[1].receivers[0];
  const double angle = -2 * kPi / 16;
  EXPECT_NEAR(post.normal.x, std::cos(angle), 1e-15);
  EXPECT_NEAR(post.normal.y, std::sin(angle), 1e-15);
  EXPECT_NEAR(post.tangent.x, std::sin(angle), 1e-15);
  EXPECT_NEAR(post.curvature / scene->frame().scale, -5, 1e-14);
  EXPECT_NEAR(scene->ToWorld(post.position).x, 0.6 + 0.2 * std::cos(angle), 1e-15);
}

TEST(SceneTest, APointOnAVertexBelongsToThePieceThatStartsThere) {
  SceneDescription description = GoodScene();
  description.curves[0].shape = PolylineDescription{{{0, 0}, {1, 0}, {1, 1}}, false};
  description.probes[0].count = 1;  // At half the length: the corner.
  const auto scene = Build(description);
  const Receiver& corner = scene->probes()[0].receivers[0];
  EXPECT_NEAR(corner.tangent.y, 1, 1e-15);
  EXPECT_EQ(corner.element, static_cast<ElementId>(1));
}

TEST(SceneTest, WhereCurvesOverlapTheFirstOneIsThere) {
  SceneDescription description = GoodScene();
  description.curves[0].shape = SegmentDescription{{-1, 2}, {0.25, 2}};  // Covers part of the lamp, which comes second.
  description.curves.push_back({"inner", ArcDescription{{0.6, 0.7}, 0.2, 1, 1}, "white", std::nullopt});
  const auto scene = Build(description);
  const Curve& lamp = scene->curves()[1];
  ASSERT_EQ(lamp.element_count, 1u);
  const Element& rest = scene->elements()[lamp.first_element];
  EXPECT_NEAR(rest.length * scene->frame().scale, 0.25, 1e-15);
  EXPECT_NEAR(scene->ToWorld(rest.b).x, 0.25, 1e-15);
  EXPECT_EQ(scene->curves()[3].element_count, 0u);
}

TEST(SceneTest, FreePointsOnACurveKnowIt) {
  SceneDescription description = GoodScene();
  ProbeDescription free;
  free.name = "free";
  free.points = {
      {{0.5, 0}, {0, 3}}, {{0.5, 0}, {0, -1}}, {{0.5, 0.1}, {0, 1}}, {{0.5, 0}, {1, 1}}, {{0.8, 0.7}, {1, 0}}};
  description.probes.push_back(free);
  const auto scene = Build(description);
  const auto& r = scene->probes()[1].receivers;
  EXPECT_EQ(r[0].element, static_cast<ElementId>(0));
  EXPECT_EQ(r[0].normal, (Vector2{0, 1}));
  EXPECT_EQ(r[1].element, static_cast<ElementId>(0));
  EXPECT_EQ(r[1].tangent, (Vector2{-1, 0}));
  EXPECT_EQ(r[2].element, ElementId::kNone);
  EXPECT_EQ(r[3].element, ElementId::kNone);  // Its normal is not the floor's: lifted off the floor.
  EXPECT_GT(scene->ToWorld(r[3].position).y, 0);
  EXPECT_NE(r[4].element, ElementId::kNone);
}

TEST(SceneTest, HashesTellWorldsApartAndIgnoreNames) {
  const SceneDescription one = GoodScene();
  SceneDescription renamed = GoodScene();
  renamed.name = "other";
  renamed.materials[0].name = renamed.curves[0].material = renamed.curves[1].material = renamed.curves[2].material =
      "snow";
  renamed.curves[0].name = "ground";
  renamed.probes[0].curve = "ground";
  const auto a = Build(one), b = Build(renamed);
  EXPECT_THAT(a->world_hash(), SizeIs(64));
  EXPECT_EQ(a->world_hash(), b->world_hash());
  EXPECT_EQ(a->probe_hash(), b->probe_hash());
  SceneDescription brighter = GoodScene();
  brighter.curves[1].emission->radiance = {5.000000000000001};
  EXPECT_NE(Build(brighter)->world_hash(), a->world_hash());
  EXPECT_EQ(Build(brighter)->probe_hash(), a->probe_hash());
  SceneDescription denser = GoodScene();
  denser.probes[0].count = 5;
  EXPECT_EQ(Build(denser)->world_hash(), a->world_hash());
  EXPECT_NE(Build(denser)->probe_hash(), a->probe_hash());
}

TEST(SceneTest, TraitsTellWhatThePlannerAsks) {
  SceneDescription description = GoodScene();
  const auto grey = Build(description);
  EXPECT_EQ(grey->channels(), 1);
  EXPECT_TRUE(grey->traits().grey);
  EXPECT_EQ(grey->traits().emitting_curves, 1u);
  EXPECT_EQ(grey->traits().max_reflectance, 0.8);
  EXPECT_EQ(grey->traits().probe_points, 4u);
  description.materials[0].kind = LambertianDescription{{0.5, 0.5, 0.5}};
  const auto equal = Build(description);
  EXPECT_EQ(equal->channels(), 3);
  EXPECT_TRUE(equal->traits().grey);
  description.materials[0].kind = LambertianDescription{{0.5, 0.25, 0.5}};
  EXPECT_FALSE(Build(description)->traits().grey);
}

TEST(SceneTest, PiecesLostBesideTheWholeSceneAreRefused) {
  SceneDescription description = GoodScene();
  description.curves[0].shape = SegmentDescription{{1e-200, 0}, {2e-200, 0}};
  EXPECT_THAT(Mistakes(description), ElementsAre(testing::AllOf(HasSubstr("plane.curves[0]"), HasSubstr("too short"))));
}

}  // namespace
}  // namespace flatlight
