// SPDX-License-Identifier: Apache-2.0
#include "server/convert/scene_convert.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "flatlight/v1/scene.pb.h"
#include "flatlight/v1/scene_service.pb.h"

namespace flatlight {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

constexpr char kRoom[] = R"({"name":"room","plane":{
  "materials":[{"name":"white","lambertian":{"reflectance":[0.5]}}],
  "curves":[{"name":"floor","segment":{"a":{"x":-2,"y":0},"b":{"x":2,"y":0}},"material":"white"},
            {"name":"post","arc":{"center":{"x":0,"y":1},"radius":0.2,"startAngle":0,"sweepAngle":-6},"material":"white",
             "emission":{"radiance":[1,2,3],"twoSided":true}},
            {"name":"zigzag","polyline":{"points":[{"x":1,"y":1},{"x":2,"y":1},{"x":2,"y":2}],"closed":true},
             "material":"white"}]},
  "probes":[{"name":"on floor","curve":"floor","count":4,"from":0.5,"to":1,"side":"BACK"},
            {"name":"free","points":[{"position":{"x":0,"y":0.5},"normal":{"x":0,"y":2}}]}]})";

std::vector<std::string> Paths(const Diagnostics& diagnostics) {
  std::vector<std::string> paths;
  for (const Diagnostic& mistake : diagnostics.kept()) paths.push_back(mistake.path);
  return paths;
}

v1::Scene Room() {
  v1::Scene proto;
  Diagnostics diagnostics;
  EXPECT_NE(SceneFromJson(kRoom, proto, diagnostics), nullptr);
  EXPECT_THAT(Paths(diagnostics), IsEmpty());
  return proto;
}

TEST(SceneConvertTest, BuildsTheSceneThatWasWritten) {
  Diagnostics diagnostics;
  const auto scene = SceneFromProto(Room(), diagnostics);
  ASSERT_NE(scene, nullptr);
  EXPECT_EQ(scene->name(), "room");
  EXPECT_EQ(scene->channels(), 3);
  ASSERT_EQ(scene->curves().size(), 3U);
  EXPECT_EQ(scene->curves()[0].reflectance, Spectrum::Grey(0.5));
  EXPECT_FALSE(scene->curves()[0].Emits());
  EXPECT_TRUE(scene->curves()[1].two_sided);
  EXPECT_DOUBLE_EQ(scene->frame().radiance_scale * scene->curves()[1].radiance[2], 3);
  EXPECT_EQ(scene->curves()[2].element_count, 3U);
  ASSERT_EQ(scene->probes().size(), 2U);
  ASSERT_EQ(scene->probes()[0].receivers.size(), 4U);
  EXPECT_DOUBLE_EQ(scene->ToWorld(scene->probes()[0].receivers[0].position).x, 0.25);
  EXPECT_DOUBLE_EQ(scene->probes()[0].receivers[0].normal.y, -1);
  EXPECT_DOUBLE_EQ(scene->probes()[1].receivers[0].normal.y, 1);
}

// Every material and light there is, in one scene.
constexpr char kShow[] = R"({"name":"show","plane":{
  "materials":[{"name":"m","mirror":{"reflectance":[0.9]}},{"name":"d","dielectric":{"ior":1.5}},
               {"name":"p","phong":{"reflectance":[0.5,0.6,0.7],"exponent":20}},
               {"name":"c","conductor":{"reflectance":[0.8],"roughness":0.5}}],
  "curves":[{"name":"m","segment":{"a":{"x":-2,"y":0},"b":{"x":2,"y":0}},"material":"m"},
            {"name":"d","segment":{"a":{"x":-2,"y":1},"b":{"x":2,"y":1}},"material":"d"},
            {"name":"p","segment":{"a":{"x":-2,"y":2},"b":{"x":2,"y":2}},"material":"p"},
            {"name":"c","segment":{"a":{"x":-2,"y":3},"b":{"x":2,"y":3}},"material":"c"}],
  "lights":[{"name":"bulb","point":{"position":{"x":0,"y":0.5},"power":[6.283185307179586]}},
            {"name":"spot","spot":{"position":{"x":1,"y":0.5},"direction":{"x":0,"y":-2},"power":[3],
             "coneAngle":0.5,"edgeAngle":1}},
            {"name":"sun","directional":{"direction":{"x":3,"y":-4},"irradiance":[7]}}],
  "environment":{"radiance":[0.25]}},
  "probes":[{"name":"p","curve":"m","count":4}]})";

v1::Scene Show() {
  v1::Scene proto;
  Diagnostics diagnostics;
  EXPECT_NE(SceneFromJson(kShow, proto, diagnostics), nullptr);
  EXPECT_THAT(Paths(diagnostics), IsEmpty());
  return proto;
}

TEST(SceneConvertTest, KnowsEveryMaterialAndLight) {
  Diagnostics diagnostics;
  const auto scene = SceneFromProto(Show(), diagnostics);
  ASSERT_NE(scene, nullptr);
  const auto& curves = scene->curves();
  EXPECT_EQ(std::get<Mirror>(curves[0].material).reflectance, Spectrum::Grey(0.9));
  EXPECT_EQ(std::get<Dielectric>(curves[1].material).ior, 1.5);
  EXPECT_EQ(curves[1].reflectance, Spectrum::Grey(1));
  EXPECT_EQ(std::get<Phong>(curves[2].material).exponent, 20);
  EXPECT_EQ(std::get<Conductor>(curves[3].material).alpha, 0.25);
  EXPECT_EQ(scene->channels(), 3);
  EXPECT_FALSE(scene->traits().lambertian);
  const double unit = scene->frame().radiance_scale * scene->frame().scale;
  ASSERT_EQ(scene->lights().size(), 3U);
  const auto& bulb = std::get<PointLight>(scene->lights()[0].kind);
  EXPECT_DOUBLE_EQ(unit * bulb.intensity[0], 1);
  EXPECT_EQ(bulb.Share({1, 7}), 1);
  const auto& spot = std::get<PointLight>(scene->lights()[1].kind);
  EXPECT_DOUBLE_EQ(unit * spot.intensity[0], 2);
  EXPECT_EQ(spot.axis, (Vector2{0, -1}));
  EXPECT_EQ(spot.Share({0.4, -1}), 1);
  EXPECT_EQ(spot.Share({2, -1}), 0);
  const auto& sun = std::get<DirectionalLight>(scene->lights()[2].kind);
  EXPECT_DOUBLE_EQ(scene->frame().radiance_scale * sun.irradiance[0], 7);
  EXPECT_DOUBLE_EQ(sun.direction.x, 0.6);
  EXPECT_DOUBLE_EQ(scene->frame().radiance_scale * scene->environment()[2], 0.25);
}

TEST(SceneConvertTest, BeziersComeOver) {
  v1::Scene proto;
  Diagnostics diagnostics;
  const auto scene = SceneFromJson(
      R"({"name": "b", "plane": {"materials": [{"name": "m", "lambertian": {"reflectance": [0]}}],
          "curves": [{"name": "c", "bezier": {"p0": {"x": 0, "y": 1}, "p1": {"x": 2, "y": 3}, "p2": {"x": 4, "y": 5.5},
                      "p3": {"x": 6, "y": 0}}, "material": "m"}]},
          "probes": [{"name": "p", "curve": "c", "count": 2}]})",
      proto, diagnostics);
  ASSERT_TRUE(scene) << diagnostics.kept()[0].path << diagnostics.kept()[0].message;
  ASSERT_EQ(scene->beziers().size(), 1U);
  EXPECT_EQ(scene->ToWorld(scene->beziers()[0].p[0]), (Point2{0, 1}));
  EXPECT_EQ(scene->ToWorld(scene->beziers()[0].p[1]), (Point2{2, 3}));
  EXPECT_EQ(scene->ToWorld(scene->beziers()[0].p[2]), (Point2{4, 5.5}));
  EXPECT_EQ(scene->ToWorld(scene->beziers()[0].p[3]), (Point2{6, 0}));
  proto.mutable_plane()->mutable_curves(0)->mutable_bezier()->clear_p2();
  proto.mutable_plane()->mutable_curves(0)->mutable_bezier()->mutable_p3()->clear_y();
  EXPECT_FALSE(SceneFromProto(proto, diagnostics));
  ASSERT_EQ(diagnostics.count(), 2U);
  EXPECT_EQ(diagnostics.kept()[0].path, "plane.curves[0].bezier.p2");
  EXPECT_EQ(diagnostics.kept()[1].path, "plane.curves[0].bezier.p3.y");
}

struct Removal {
  const char* path;
  std::function<void(v1::Scene&)> remove;
};

TEST(SceneConvertTest, NamesWhatIsMissingAndOnlyThat) {
  const auto curve = [](v1::Scene& scene, int i) { return scene.mutable_plane()->mutable_curves(i); };
  const auto arc = [&](v1::Scene& scene) { return curve(scene, 1)->mutable_arc(); };
  const std::vector<Removal> removals = {
      {"plane", [&](v1::Scene& s) { s.clear_plane(); }},
      {"plane.materials[0].name",
       [&](v1::Scene& s) {
         curve(s, 0);
         s.mutable_plane()->mutable_materials(0)->clear_name();
         s.mutable_plane()->add_materials()->CopyFrom(s.plane().materials(0));
         s.mutable_plane()->mutable_materials(1)->set_name("white");
       }},
      {"plane.materials[0]", [&](v1::Scene& s) { s.mutable_plane()->mutable_materials(0)->clear_lambertian(); }},
      {"plane.materials[0].lambertian.reflectance",
       [&](v1::Scene& s) { s.mutable_plane()->mutable_materials(0)->mutable_lambertian()->clear_reflectance(); }},
      {"plane.curves[0]", [&](v1::Scene& s) { curve(s, 0)->clear_segment(); }},
      {"plane.curves[0].material", [&](v1::Scene& s) { curve(s, 0)->clear_material(); }},
      {"plane.curves[0].segment.a", [&](v1::Scene& s) { curve(s, 0)->mutable_segment()->clear_a(); }},
      {"plane.curves[0].segment.b.y", [&](v1::Scene& s) { curve(s, 0)->mutable_segment()->mutable_b()->clear_y(); }},
      {"plane.curves[1].arc.center", [&](v1::Scene& s) { arc(s)->clear_center(); }},
      {"plane.curves[1].arc.center.x", [&](v1::Scene& s) { arc(s)->mutable_center()->clear_x(); }},
      {"plane.curves[1].arc.radius", [&](v1::Scene& s) { arc(s)->clear_radius(); }},
      {"plane.curves[1].arc.startAngle", [&](v1::Scene& s) { arc(s)->clear_start_angle(); }},
      {"plane.curves[1].arc.sweepAngle", [&](v1::Scene& s) { arc(s)->clear_sweep_angle(); }},
      {"plane.curves[1].emission.radiance", [&](v1::Scene& s) { curve(s, 1)->mutable_emission()->clear_radiance(); }},
      {"plane.curves[2].polyline.points[1].y",
       [&](v1::Scene& s) { curve(s, 2)->mutable_polyline()->mutable_points(1)->clear_y(); }},
      {"plane.curves[2].polyline.points", [&](v1::Scene& s) { curve(s, 2)->mutable_polyline()->clear_points(); }},
      {"probes", [&](v1::Scene& s) { s.clear_probes(); }},
      {"probes[0].name", [&](v1::Scene& s) { s.mutable_probes(0)->clear_name(); }},
      {"probes[0].count", [&](v1::Scene& s) { s.mutable_probes(0)->clear_count(); }},
      {"probes[1]", [&](v1::Scene& s) { s.mutable_probes(1)->clear_points(); }},
      {"probes[1].points[0].position", [&](v1::Scene& s) { s.mutable_probes(1)->mutable_points(0)->clear_position(); }},
      {"probes[1].points[0].normal", [&](v1::Scene& s) { s.mutable_probes(1)->mutable_points(0)->clear_normal(); }},
      {"probes[1].points[0].normal.x",
       [&](v1::Scene& s) { s.mutable_probes(1)->mutable_points(0)->mutable_normal()->clear_x(); }},
  };
  for (const Removal& removal : removals) {
    v1::Scene proto = Room();
    removal.remove(proto);
    Diagnostics diagnostics;
    EXPECT_EQ(SceneFromProto(proto, diagnostics), nullptr) << removal.path;
    EXPECT_THAT(Paths(diagnostics), ElementsAre(removal.path));
  }
}

TEST(SceneConvertTest, NamesWhatMaterialsAndLightsMiss) {
  const auto material = [](v1::Scene& scene, int i) { return scene.mutable_plane()->mutable_materials(i); };
  const auto light = [](v1::Scene& scene, int i) { return scene.mutable_plane()->mutable_lights(i); };
  const std::vector<Removal> spoilers = {
      {"plane.materials[0].mirror.reflectance",
       [&](v1::Scene& s) { material(s, 0)->mutable_mirror()->clear_reflectance(); }},
      {"plane.materials[1].dielectric.ior", [&](v1::Scene& s) { material(s, 1)->mutable_dielectric()->clear_ior(); }},
      {"plane.materials[1].dielectric.ior", [&](v1::Scene& s) { material(s, 1)->mutable_dielectric()->set_ior(0); }},
      {"plane.materials[2].phong.exponent", [&](v1::Scene& s) { material(s, 2)->mutable_phong()->clear_exponent(); }},
      {"plane.materials[2].phong.exponent", [&](v1::Scene& s) { material(s, 2)->mutable_phong()->set_exponent(-1); }},
      {"plane.materials[3].conductor.roughness",
       [&](v1::Scene& s) { material(s, 3)->mutable_conductor()->clear_roughness(); }},
      {"plane.materials[3].conductor.reflectance[0]",
       [&](v1::Scene& s) { material(s, 3)->mutable_conductor()->set_reflectance(0, 1.01); }},
      {"plane.lights[0]", [&](v1::Scene& s) { light(s, 0)->clear_point(); }},
      {"plane.lights[1].name", [&](v1::Scene& s) { light(s, 1)->set_name("bulb"); }},
      {"plane.lights[0].point.position", [&](v1::Scene& s) { light(s, 0)->mutable_point()->clear_position(); }},
      {"plane.lights[0].point.power", [&](v1::Scene& s) { light(s, 0)->mutable_point()->clear_power(); }},
      {"plane.lights[0].point.power[0]", [&](v1::Scene& s) { light(s, 0)->mutable_point()->set_power(0, -1); }},
      {"plane.lights[1].spot.direction", [&](v1::Scene& s) { light(s, 1)->mutable_spot()->clear_direction(); }},
      {"plane.lights[1].spot.coneAngle", [&](v1::Scene& s) { light(s, 1)->mutable_spot()->clear_cone_angle(); }},
      {"plane.lights[1].spot.edgeAngle", [&](v1::Scene& s) { light(s, 1)->mutable_spot()->set_edge_angle(0.4); }},
      {"plane.lights[2].directional.direction",
       [&](v1::Scene& s) { light(s, 2)->mutable_directional()->mutable_direction()->set_x(0); }},
      {"plane.lights[2].directional.irradiance",
       [&](v1::Scene& s) { light(s, 2)->mutable_directional()->clear_irradiance(); }},
      {"plane.environment.radiance", [&](v1::Scene& s) { s.mutable_plane()->mutable_environment()->clear_radiance(); }},
  };
  for (const Removal& spoiler : spoilers) {
    v1::Scene proto = Show();
    if (std::string(spoiler.path) == "plane.lights[2].directional.direction")
      proto.mutable_plane()->mutable_lights(2)->mutable_directional()->mutable_direction()->set_y(0);
    spoiler.remove(proto);
    Diagnostics diagnostics;
    EXPECT_EQ(SceneFromProto(proto, diagnostics), nullptr) << spoiler.path;
    EXPECT_THAT(Paths(diagnostics), ElementsAre(spoiler.path));
  }
}

TEST(SceneConvertTest, RefusesFieldsOfAnotherVersion) {
  v1::Scene proto = Room();
  v1::Curve* const curve = proto.mutable_plane()->mutable_curves(1);
  curve->GetReflection()->MutableUnknownFields(curve)->AddVarint(99, 1);
  proto.GetReflection()->MutableUnknownFields(&proto)->AddLengthDelimited(98)->append("x");
  Diagnostics diagnostics;
  EXPECT_EQ(SceneFromProto(proto, diagnostics), nullptr);
  EXPECT_THAT(Paths(diagnostics), ElementsAre("98", "plane.curves[1].99"));
}

TEST(SceneConvertTest, RefusesEnumValuesOfAnotherVersion) {
  v1::Scene proto = Room();
  proto.mutable_probes(0)->set_side(static_cast<v1::Probe::Side>(7));
  Diagnostics diagnostics;
  EXPECT_EQ(SceneFromProto(proto, diagnostics), nullptr);
  ASSERT_THAT(Paths(diagnostics), ElementsAre("probes[0].side"));
  EXPECT_THAT(diagnostics.kept()[0].message, HasSubstr("7"));
  EXPECT_THAT(diagnostics.kept()[0].message, HasSubstr("FRONT, BACK"));
}

TEST(SceneConvertTest, ReportsMistakesOfFormAndOfMeaningTogether) {
  v1::Scene proto;
  Diagnostics diagnostics;
  EXPECT_EQ(SceneFromJson(R"({"name":"eight","plane":{
      "materials":[{"name":"white","lambertian":{"reflectance":[1.5]}}],
      "curves":[{"name":"floor","segment":{"a":{"x":0,"y":0},"b":{"x":0,"y":0}},"material":"white"},
                {"name":"lamp","segment":{"a":{"x":"1","y":1},"b":{"x":0,"y":1}},"material":"wite",
                 "emission":{"radiance":[-5]}},
                {"name":"lamp","arc":{"center":{"x":0,"y":0},"radius":null,"startAngle":0},"material":"white"}]},
      "probes":[{"name":"p","curve":"flor","count":0,"form":0.5}]})",
                          proto, diagnostics),
            nullptr);
  EXPECT_THAT(
      Paths(diagnostics),
      UnorderedElementsAre("plane.materials[0].lambertian.reflectance[0]", "plane.curves[0].segment",
                           "plane.curves[1].segment.a.x", "plane.curves[1].material",
                           "plane.curves[1].emission.radiance[0]", "plane.curves[2].name", "plane.curves[2].arc.radius",
                           "plane.curves[2].arc.sweepAngle", "probes[0].curve", "probes[0].count", "probes[0].form"));
}

// What follows from a mistake is not reported as another.
TEST(SceneConvertTest, OneMistakeIsReportedOnce) {
  const std::string material = R"("materials":[{"name":"white","lambertian":{"reflectance":[0.5]}}])";
  const std::string floor = R"({"name":"floor","segment":{"a":{"x":0,"y":0},"b":{"x":1,"y":0}},"material":"white"})";
  const std::string probe = R"("probes":[{"name":"p","curve":"floor","count":4}])";
  const auto scene = [&](const std::string& plane, const std::string& probes) {
    return "{\"plane\":{" + plane + "}," + probes + "}";
  };
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"{\"plain\":{}," + probe + "}", "plain"},
      {"[]", "scene"},
      {scene(R"("material":[],"curves":[)" + floor + "]", probe), "plane.material"},
      {scene(R"("materials":{},"curves":[)" + floor + "]", probe), "plane.materials"},
      {scene(R"("materials":[{"nmae":"white","lambertian":{"reflectance":[0.5]}}],"curves":[)" + floor + "]", probe),
       "plane.materials[0].nmae"},
      {scene(R"("materials":["white"],"curves":[)" + floor + "]", probe), "plane.materials[0]"},
      {scene(R"("materials":[{"name":"white","lambertain":{"reflectance":[0.5]}}],"curves":[)" + floor + "]", probe),
       "plane.materials[0].lambertain"},
      {scene(R"("materials":[{"name":"white","lambertian":{"reflectance":0.5}}],"curves":[)" + floor + "]", probe),
       "plane.materials[0].lambertian.reflectance"},
      {scene(R"("materials":[{"name":"white","lambertian":{"reflektance":[0.5]}}],"curves":[)" + floor + "]", probe),
       "plane.materials[0].lambertian.reflektance"},
      {scene(material + R"(,"curve":[)" + floor + "]", probe), "plane.curve"},
      {scene(material + R"(,"curves":[{"name":"floor","segmnet":{},"material":"white"}])", probe),
       "plane.curves[0].segmnet"},
      {scene(material + R"(,"curves":[{"name":"floor"," segment":{},"material":"white"}])", probe),
       "plane.curves[0][\" segment\"]"},
      {scene(material + R"(,"curves":[{"name":"floor","segment":[0,0,1,0],"material":"white"}])", probe),
       "plane.curves[0].segment"},
      {scene(material + R"(,"curves":[{"name":"floor","segment":{"A":{"x":0,"y":0},"b":{"x":1,"y":0}},
          "material":"white"}])",
             probe),
       "plane.curves[0].segment.A"},
      {scene(material + R"(,"curves":[{"Name":"floor","segment":{"a":{"x":0,"y":0},"b":{"x":1,"y":0}},
          "material":"white"}])",
             probe),
       "plane.curves[0].Name"},
      {scene(material + ",\"curves\":[" + floor + "]", R"("prober":[])"), "prober"},
      {scene(material + ",\"curves\":[" + floor + "]", R"("probes":[{"name":"p","curv":"floor","count":4}])"),
       "probes[0].curv"},
      {scene(material + ",\"curves\":[" + floor + "]", R"("probes":[{"name":"p","curve":5,"count":4,"from":0.5}])"),
       "probes[0].curve"},
      {scene(material + ",\"curves\":[" + floor + "]", R"("probes":[{"name":"p","curve":"floor","count":"4"}])"),
       "probes[0].count"},
      {scene(material + ",\"curves\":[" + floor + "]",
             R"("probes":[{"name":"p","points":[{"position":{"x":0,"y":1},"normal":"up"}]}])"),
       "probes[0].points[0].normal"},
  };
  for (const auto& [json, path] : cases) {
    v1::Scene proto;
    Diagnostics diagnostics;
    EXPECT_EQ(SceneFromJson(json, proto, diagnostics), nullptr);
    EXPECT_THAT(Paths(diagnostics), ElementsAre(path)) << json;
  }
}

TEST(SceneConvertTest, ManyMistakesOfFormEndTheSearch) {
  std::string json = R"({"probes":[1)";
  for (int i = 0; i < 2000; ++i) json += ",1";
  v1::Scene proto;
  Diagnostics diagnostics;
  EXPECT_EQ(SceneFromJson(json + "]}", proto, diagnostics), nullptr);
  EXPECT_EQ(diagnostics.count(), 2001U);
}

// A name is shown in part, and never cut inside a character: whoever receives such a message would refuse it.
TEST(SceneConvertTest, MessagesStayUtf8) {
  for (int shift = 0; shift < 4; ++shift) {
    std::string name(static_cast<std::size_t>(shift), 'x');
    for (int i = 0; i < 50; ++i) name += "\xe2\x82\xac";
    v1::Scene proto = Room();
    proto.mutable_plane()->mutable_curves(0)->set_material(name);
    proto.mutable_plane()->mutable_materials(0)->set_name(name + "y");
    Diagnostics diagnostics;
    EXPECT_EQ(SceneFromProto(proto, diagnostics), nullptr);
    v1::Diagnostic sent;
    sent.set_message(diagnostics.kept().at(0).message);
    v1::Diagnostic received;
    EXPECT_TRUE(received.ParseFromString(sent.SerializeAsString())) << shift;
  }
}

// A terminal would obey them.
TEST(SceneConvertTest, MessagesShowNoControlCharacters) {
  v1::Scene proto;
  Diagnostics diagnostics;
  SceneFromJson(R"({"plane":{"curves":[{"material":"\u001b[31mred\u0007","\u001bodd":1}]},
      "probes":[{"side":"\u001b[2J"},{"curve":"\u0000"}]})",
                proto, diagnostics);
  EXPECT_GE(diagnostics.count(), 4U);
  for (const Diagnostic& mistake : diagnostics.kept()) {
    for (const char c : mistake.path + mistake.message) EXPECT_GE(c, ' ') << mistake.path;
  }
}

}  // namespace
}  // namespace flatlight
