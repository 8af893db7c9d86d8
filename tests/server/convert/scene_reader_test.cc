// SPDX-License-Identifier: Apache-2.0
#include "server/convert/scene_reader.h"

#include <gmock/gmock.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "flatlight/v1/scene.pb.h"

namespace flatlight {
namespace {

using google::protobuf::util::MessageDifferencer;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr char kPenumbra[] = R"({ "name": "penumbra",
  "plane": {
    "materials": [ {"name":"white","lambertian":{"reflectance":[0.8]}} ],
    "curves": [
      {"name":"floor","segment":{"a":{"x":-2,"y":0},"b":{"x":2,"y":0}},"material":"white"},
      {"name":"lamp","polyline":{"points":[{"x":0.5,"y":2},{"x":-0.5,"y":2}],"closed":false},"material":"white",
       "emission":{"radiance":[5,4,3e0],"twoSided":true}},
      {"name":"post","arc":{"center":{"x":0.6,"y":0.7},"radius":0.2,"startAngle":0,"sweepAngle":-6.283185307179586},
       "material":"white"} ] },
  "probes": [ {"name":"floor","curve":"floor","count":256,"from":0.25,"to":1,"side":"BACK"},
              {"name":"free","points":[{"position":{"x":1,"y":2},"normal":{"x":0,"y":-1}}]} ] })";

std::vector<std::string> Paths(const Diagnostics& diagnostics) {
  std::vector<std::string> paths;
  for (const Diagnostic& mistake : diagnostics.kept()) paths.push_back(mistake.path);
  return paths;
}

v1::Scene ReadGood(const std::string& json) {
  v1::Scene scene;
  Diagnostics diagnostics;
  EXPECT_TRUE(ReadSceneJson(json, scene, diagnostics)) << json;
  EXPECT_THAT(Paths(diagnostics), ElementsAre());
  return scene;
}

TEST(SceneReaderTest, ReadsEveryField) {
  const v1::Scene scene = ReadGood(kPenumbra);
  EXPECT_EQ(scene.name(), "penumbra");
  ASSERT_EQ(scene.plane().curves_size(), 3);
  EXPECT_EQ(scene.plane().materials(0).lambertian().reflectance(0), 0.8);
  EXPECT_EQ(scene.plane().curves(0).segment().a().x(), -2);
  EXPECT_EQ(scene.plane().curves(0).material(), "white");
  const v1::Curve& lamp = scene.plane().curves(1);
  EXPECT_EQ(lamp.polyline().points(1).x(), -0.5);
  EXPECT_THAT(lamp.emission().radiance(), ElementsAre(5, 4, 3));
  EXPECT_TRUE(lamp.emission().two_sided());
  EXPECT_EQ(scene.plane().curves(2).arc().sweep_angle(), -6.283185307179586);
  EXPECT_TRUE(scene.plane().curves(2).arc().has_start_angle());
  ASSERT_EQ(scene.probes_size(), 2);
  EXPECT_EQ(scene.probes(0).count(), 256U);
  EXPECT_EQ(scene.probes(0).side(), v1::Probe::BACK);
  EXPECT_FALSE(scene.probes(1).has_curve());
  EXPECT_EQ(scene.probes(1).points(0).normal().y(), -1);
}

TEST(SceneReaderTest, AcceptsSnakeCaseNamesToo) {
  const v1::Scene scene =
      ReadGood(R"({"plane":{"curves":[{"arc":{"start_angle":1,"sweep_angle":2},"emission":{"two_sided":true}}]}})");
  EXPECT_EQ(scene.plane().curves(0).arc().start_angle(), 1);
  EXPECT_EQ(scene.plane().curves(0).arc().sweep_angle(), 2);
  EXPECT_TRUE(scene.plane().curves(0).emission().two_sided());
}

TEST(SceneReaderTest, AcceptsAByteOrderMarkAndAnySpace) {
  EXPECT_EQ(ReadGood("\xef\xbb\xbf\r\n\t {\"name\" : \"a\"}\r\n").name(), "a");
}

TEST(SceneReaderTest, AcceptsWholeCountsInAnySpelling) {
  for (const char* const count : {"256", "256.0", "2.56e2", "25600E-2"}) {
    EXPECT_EQ(ReadGood(R"({"probes":[{"count":)" + std::string(count) + "}]}").probes(0).count(), 256U) << count;
  }
  EXPECT_EQ(ReadGood(R"({"probes":[{"count":4294967295}]})").probes(0).count(), 4294967295U);
  EXPECT_EQ(ReadGood(R"({"probes":[{"count":-0}]})").probes(0).count(), 0U);
}

TEST(SceneReaderTest, ReadsNumbersToTheLastBit) {
  const v1::Scene scene = ReadGood(R"({"plane":{"materials":[{"lambertian":{"reflectance":
      [0.1, 0.30000000000000004, 1.7976931348623157e308, 5e-324, 1e-400, 9007199254740993, 18446744073709551616]}}]}})");
  EXPECT_THAT(scene.plane().materials(0).lambertian().reflectance(),
              ElementsAre(0.1, 0.1 + 0.2, 0x1.fffffffffffffp+1023, 0x1p-1074, 0.0, 9007199254740992.0, 0x1p64));
}

TEST(SceneReaderTest, ReplacesWhatTheSceneHeld) {
  v1::Scene scene;
  scene.set_name("old");
  scene.add_probes();
  Diagnostics diagnostics;
  EXPECT_TRUE(ReadSceneJson("{}", scene, diagnostics));
  EXPECT_TRUE(MessageDifferencer::Equals(scene, v1::Scene()));
}

struct Mistake {
  const char* json;
  const char* path;
  std::vector<std::string> said;  // Parts of the message.
};

class SceneReaderMistakeTest : public testing::TestWithParam<Mistake> {};

TEST_P(SceneReaderMistakeTest, IsTheOnlyOneAndNamesPathValueAndWhatIsAllowed) {
  v1::Scene scene;
  Diagnostics diagnostics;
  EXPECT_FALSE(ReadSceneJson(GetParam().json, scene, diagnostics));
  ASSERT_THAT(Paths(diagnostics), ElementsAre(GetParam().path)) << GetParam().json;
  for (const std::string& part : GetParam().said) EXPECT_THAT(diagnostics.kept()[0].message, HasSubstr(part));
}

INSTANTIATE_TEST_SUITE_P(
    Form, SceneReaderMistakeTest,
    testing::Values(
        Mistake{R"({"nmae":"a"})", "nmae", {"not a known field", "name, plane, probes"}},
        Mistake{R"({"plane":{"curves":[{},{"colour":{"deep":[null,{"x":1,"x":2}]}}]}})",
                "plane.curves[1].colour",
                {"allowed here: name, segment, polyline, arc, bezier, material, emission"}},
        Mistake{R"({"a b":1})", R"(["a b"])", {"not a known field"}},
        Mistake{R"({"plane":{"":1}})", R"(plane[""])", {"not a known field"}},
        Mistake{R"({"name":"a","name":"b"})", "name", {"given twice"}},
        Mistake{R"({"plane":{},"plane":{"curves":5}})", "plane", {"given twice"}},
        Mistake{R"({"plane":{"curves":[{"arc":{"startAngle":1,"start_angle":1}}]}})",
                "plane.curves[0].arc.startAngle",
                {"given twice", "start_angle"}},
        Mistake{R"({"plane":{"curves":[{"arc":{"sweep_angle":1,"sweepAngle":null}}]}})",
                "plane.curves[0].arc.sweepAngle",
                {"given twice"}},
        Mistake{R"({"name":null})", "name", {"is null", "a string is wanted"}},
        Mistake{R"({"plane":null})",
                "plane",
                {"is null", "an object with materials, curves, lights, environment is wanted"}},
        Mistake{R"({"probes":[null]})", "probes[0]", {"is null"}},
        Mistake{R"({"plane":{"curves":[{"emission":{"radiance":[1,null,3]}}]}})",
                "plane.curves[0].emission.radiance[1]",
                {"is null", "a number is wanted"}},
        Mistake{R"({"name":5})", "name", {"the number 5", "a string is wanted"}},
        Mistake{R"({"name":[]})", "name", {"an array"}},
        Mistake{R"({"plane":{"curves":{}}})", "plane.curves", {"an object", "an array of objects"}},
        Mistake{R"({"plane":{"curves":[[]]}})", "plane.curves[0]", {"an array", "an object with name"}},
        Mistake{R"({"plane":{"curves":[{"arc":{"radius":"0.2"}}]}})",
                "plane.curves[0].arc.radius",
                {"the string \"0.2\"", "a number is wanted"}},
        Mistake{R"({"plane":{"curves":[{"arc":{"radius":true}}]}})", "plane.curves[0].arc.radius", {"is true"}},
        Mistake{R"({"plane":{"curves":[{"emission":{"radiance":5}}]}})",
                "plane.curves[0].emission.radiance",
                {"the number 5", "an array of numbers is wanted"}},
        Mistake{R"({"plane":{"curves":[{"emission":{"twoSided":1}}]}})",
                "plane.curves[0].emission.twoSided",
                {"the number 1", "true or false"}},
        Mistake{R"({"plane":{"curves":[{"emission":{"twoSided":"true"}}]}})",
                "plane.curves[0].emission.twoSided",
                {"the string \"true\"", "true or false"}},
        Mistake{R"({"plane":{"curves":[{"segment":{},"arc":{"radius":"x"}}]}})",
                "plane.curves[0].arc",
                {"segment", "only one of segment, polyline, arc, bezier"}},
        Mistake{R"({"probes":[{"side":"LEFT"}]})", "probes[0].side", {"\"LEFT\"", "FRONT, BACK"}},
        Mistake{R"({"probes":[{"side":"front"}]})", "probes[0].side", {"\"front\"", "FRONT, BACK"}},
        Mistake{R"({"probes":[{"side":"SIDE_UNSPECIFIED"}]})", "probes[0].side", {"FRONT, BACK is wanted"}},
        Mistake{R"({"probes":[{"side":1}]})", "probes[0].side", {"the number 1", "FRONT, BACK"}},
        Mistake{R"({"probes":[{"count":-3}]})", "probes[0].count", {"is -3", "0 to 4294967295"}},
        Mistake{R"({"probes":[{"count":1.5}]})", "probes[0].count", {"is 1.5", "whole number"}},
        Mistake{R"({"probes":[{"count":4294967296}]})", "probes[0].count", {"is 4294967296", "0 to 4294967295"}},
        Mistake{R"({"probes":[{"count":1e300}]})", "probes[0].count", {"is 1e300"}},
        Mistake{R"({"probes":[{"count":"256"}]})", "probes[0].count", {"the string \"256\"", "whole number"}},
        Mistake{R"({"plane":{"curves":[{"arc":{"radius":1e999}}]}})",
                "plane.curves[0].arc.radius",
                {"is 1e999", "1.797e308"}},
        Mistake{R"({"plane":{"curves":[{"segment":{"a":{"x":1, "y":-Infinity}}}]}})",
                "plane.curves[0].segment.a.y",
                {"is -Infinity", "not finite"}},
        Mistake{R"({"plane":{"curves":[{"emission":{"radiance":[1,NaN]}}]}})",
                "plane.curves[0].emission.radiance[1]",
                {"is NaN", "a number is wanted"}},
        Mistake{R"({"probes":[{"count":1e999}]})", "probes[0].count", {"is 1e999"}},
        Mistake{"[1,{}]", "scene", {"an array", "an object with name, plane, probes is wanted"}},
        Mistake{"7", "scene", {"a number"}}, Mistake{"null", "scene", {"null"}},
        Mistake{"\"{}\"", "scene", {"a string"}}));

INSTANTIATE_TEST_SUITE_P(
    Syntax, SceneReaderMistakeTest,
    testing::Values(Mistake{"", "line 1, column 1", {"empty"}}, Mistake{" \n ", "line 2, column 2", {"empty"}},
                    Mistake{"\xef\xbb\xbf", "line 1, column 1", {"empty"}},
                    Mistake{"{\"name\":\"a\",\n  plane: {}}", "line 2, column 3", {"plane must be in double quotes"}},
                    Mistake{"{'name':\"a\"}", "line 1, column 2", {"double quotes"}},
                    Mistake{"{\"name\":\"a\",}", "line 1, column 13", {"a comma before }"}},
                    Mistake{"{\"probes\":[{},]}", "line 1, column 15", {"a comma before ]", "near probes[0]"}},
                    Mistake{"{\"name\":\"a\"} x", "line 1, column 14", {"after the end"}},
                    Mistake{"{}{}", "line 1, column 3", {"after the end"}},
                    Mistake{"{\"name\":\"a\"", "line 1, column 12", {"ends before"}},
                    Mistake{"{\"name\":\"a", "line 1, column 11", {"ends inside a string"}},
                    Mistake{"{\"name\":\"\xc3\xa4\xff\"}", "line 1, column 11", {"not UTF-8"}},
                    Mistake{"{\"name\":\"a\nb\"}", "line 1, column 11", {"control character"}},
                    Mistake{"{\"name\" \"a\"}", "line 1, column 9", {"expected ':'"}},
                    Mistake{"{\"name\": tru}", "line 1, column 10", {"tru is not a JSON value"}},
                    Mistake{"{\"name\": +1}", "line 1, column 10", {"+1 is not a JSON value"}},
                    Mistake{"{\"name\": 1e999x}", "line 1, column 10", {"1e999"}},
                    Mistake{"{} // done", "line 1, column 4", {"after the end"}},
                    Mistake{"{ // first\n}", "line 1, column 3", {"comments are not allowed"}}));

TEST(SceneReaderTest, ANulIsNoEnd) {
  for (const std::string& json : {std::string("{}\0", 3), std::string("{}\0{\"a\":1}", 10), std::string("\0", 1)}) {
    v1::Scene scene;
    Diagnostics diagnostics;
    EXPECT_FALSE(ReadSceneJson(json, scene, diagnostics));
    EXPECT_EQ(diagnostics.count(), 1U);
  }
}

TEST(SceneReaderTest, ReportsEveryMistakeAndReadsTheRest) {
  v1::Scene scene;
  Diagnostics diagnostics;
  EXPECT_FALSE(ReadSceneJson(R"({"nmae":"x", "name":"good",
      "plane":{"materials":[{"name":"m","lambertian":{"reflectance":[0.1,"0.2",NaN,1e400,null]}}],
               "curves":[null, {"name":"c","segment":{"a":{"x":"1","y":2}},"arc":{}}]},
      "probes":[{"count":-1,"side":"UP"},{"name":"p","curve":"c","count":4}]})",
                             scene, diagnostics));
  EXPECT_THAT(
      Paths(diagnostics),
      ElementsAre("nmae", "plane.materials[0].lambertian.reflectance[1]",
                  "plane.materials[0].lambertian.reflectance[2]", "plane.materials[0].lambertian.reflectance[3]",
                  "plane.materials[0].lambertian.reflectance[4]", "plane.curves[0]", "plane.curves[1].segment.a.x",
                  "plane.curves[1].arc", "probes[0].count", "probes[0].side"));
  EXPECT_EQ(scene.name(), "good");
  EXPECT_EQ(scene.plane().materials(0).lambertian().reflectance_size(), 5);
  EXPECT_TRUE(std::isnan(scene.plane().materials(0).lambertian().reflectance(2)));
  EXPECT_EQ(scene.plane().curves(1).name(), "c");
  EXPECT_EQ(scene.plane().curves(1).segment().a().y(), 2);
  EXPECT_EQ(scene.probes(1).count(), 4U);
}

TEST(SceneReaderTest, TextThatLooksLikeANumberIsLeftAloneInStrings) {
  v1::Scene scene;
  Diagnostics diagnostics;
  EXPECT_FALSE(
      ReadSceneJson(R"({"name":"NaN \" 1e999","plane":{"curves":[{"arc":{"radius":1e999}}]}})", scene, diagnostics));
  EXPECT_THAT(Paths(diagnostics), ElementsAre("plane.curves[0].arc.radius"));
  EXPECT_EQ(scene.name(), "NaN \" 1e999");
}

TEST(SceneReaderTest, KeepsEarlierMistakes) {
  v1::Scene scene;
  Diagnostics diagnostics;
  diagnostics.Add("earlier", "is wrong");
  EXPECT_TRUE(ReadSceneJson("{}", scene, diagnostics));
  EXPECT_FALSE(ReadSceneJson(R"({"probes":[{"count":NaN}]})", scene, diagnostics));
  EXPECT_THAT(Paths(diagnostics), ElementsAre("earlier", "probes[0].count"));
}

TEST(SceneReaderTest, ASyntaxErrorLeavesTheSceneEmpty) {
  v1::Scene scene;
  Diagnostics diagnostics;
  EXPECT_FALSE(ReadSceneJson(R"({"name":"a","probes":[{"name":"p"},)", scene, diagnostics));
  EXPECT_TRUE(MessageDifferencer::Equals(scene, v1::Scene()));
}

TEST(SceneReaderTest, ShortensLongValues) {
  v1::Scene scene;
  Diagnostics diagnostics;
  const std::string value(100000, 'x');
  EXPECT_FALSE(
      ReadSceneJson("{\"" + value + "\":1,\"plane\":\"" + value + "\",\"probes\":[1" + std::string(5000, '0') + "]}",
                    scene, diagnostics));
  ASSERT_EQ(diagnostics.count(), 3U);
  for (const Diagnostic& mistake : diagnostics.kept()) {
    EXPECT_LT(mistake.path.size(), 100U);
    EXPECT_LT(mistake.message.size(), 200U);
  }
}

}  // namespace
}  // namespace flatlight
