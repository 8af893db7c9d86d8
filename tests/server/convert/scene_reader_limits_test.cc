// SPDX-License-Identifier: Apache-2.0
// Input that is too deep, too long or cut off.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <string>

#include "flatlight/v1/scene.pb.h"
#include "server/convert/scene_reader.h"
#include "server/gallery/gallery.h"

namespace flatlight {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string Nested(const std::string& open, const std::string& inner, const std::string& close, int depth) {
  std::string text;
  for (int i = 0; i < depth; ++i) text += open;
  text += inner;
  for (int i = 0; i < depth; ++i) text += close;
  return text;
}

TEST(SceneReaderLimitsTest, AllowsTheStatedDepthAndNoMore) {
  for (const int depth : {kMaxSceneDepth, kMaxSceneDepth + 1}) {
    v1::Scene scene;
    Diagnostics diagnostics;
    // The scene's own object is the first level.
    EXPECT_FALSE(ReadSceneJson("{\"odd\":" + Nested("[", "", "]", depth - 1) + "}", scene, diagnostics));
    ASSERT_EQ(diagnostics.count(), depth > kMaxSceneDepth ? 2U : 1U) << depth;
    EXPECT_THAT(diagnostics.kept().back().message, HasSubstr(depth > kMaxSceneDepth ? "at most 32 levels" : "allowed"));
    EXPECT_EQ(diagnostics.kept().back().path, "odd");
  }
}

TEST(SceneReaderLimitsTest, EveryDeepValueIsReported) {
  v1::Scene scene;
  Diagnostics diagnostics;
  const std::string deep = Nested("[", "", "]", kMaxSceneDepth);
  EXPECT_FALSE(ReadSceneJson("{\"odd\":" + deep + ",\"even\":" + deep + "}", scene, diagnostics));
  ASSERT_EQ(diagnostics.count(), 4U);
  EXPECT_EQ(diagnostics.kept()[1].path, "odd");
  EXPECT_EQ(diagnostics.kept()[3].path, "even");
  EXPECT_THAT(diagnostics.kept()[3].message, HasSubstr("at most 32 levels"));
}

TEST(SceneReaderLimitsTest, DeepNestingIsReportedOnceAndCostsNothing) {
  constexpr int kDepth = 2'000'000;
  for (const std::string& json :
       {Nested("[", "", "]", kDepth), Nested("{\"plane\":", "1", "}", kDepth), Nested("{\"a\":[", "1", "]}", kDepth),
        "{\"probes\":" + Nested("[", "", "]", kDepth) + "}", Nested("[", "", "", kDepth)}) {
    v1::Scene scene;
    Diagnostics diagnostics;
    EXPECT_FALSE(ReadSceneJson(json, scene, diagnostics));
    EXPECT_LE(diagnostics.count(), 3U);
    bool told = false;
    for (const Diagnostic& mistake : diagnostics.kept()) {
      told |= mistake.message.find("at most 32 levels") != std::string::npos;
    }
    EXPECT_TRUE(told) << json.substr(0, 40);
  }
}

// Anything but linear work would take minutes here, and the test has less.
TEST(SceneReaderLimitsTest, ReadsTwoHundredThousandCurves) {
  constexpr int kCurves = 200000;
  std::string json = "{\"plane\":{\"curves\":[";
  for (int i = 0; i < kCurves; ++i) {
    json += (i > 0 ? "," : "") + std::string("{\"name\":\"") + std::to_string(i) +
            R"(","segment":{"a":{"x":0,"y":0.25},"b":{"x":1,"y":0}},"material":"m","emission":{"radiance":[1e)" +
            (i % 2 == 0 ? "2" : "999") + "]}}";
  }
  json += "]}}";
  v1::Scene scene;
  Diagnostics diagnostics;
  EXPECT_FALSE(ReadSceneJson(json, scene, diagnostics));
  EXPECT_EQ(diagnostics.count(), static_cast<std::size_t>(kCurves / 2));
  EXPECT_EQ(diagnostics.kept().size(), Diagnostics::kMaxKept);
  EXPECT_EQ(diagnostics.kept()[1].path, "plane.curves[3].emission.radiance[0]");
  ASSERT_EQ(scene.plane().curves_size(), kCurves);
  EXPECT_EQ(scene.plane().curves(kCurves - 2).emission().radiance(0), 100);
}

TEST(SceneReaderLimitsTest, EveryTruncationIsRefusedAtItsEnd) {
  for (const GalleryScene& gallery : Gallery()) {
    const std::size_t whole = gallery.json.find_last_of('}') + 1;
    for (std::size_t size = 0; size < whole; ++size) {
      v1::Scene scene;
      Diagnostics diagnostics;
      EXPECT_FALSE(ReadSceneJson(gallery.json.substr(0, size), scene, diagnostics)) << gallery.name << " " << size;
      ASSERT_FALSE(diagnostics.empty());
      EXPECT_THAT(diagnostics.kept().back().path, StartsWith("line "));
    }
    v1::Scene scene;
    Diagnostics diagnostics;
    EXPECT_TRUE(ReadSceneJson(gallery.json.substr(0, whole), scene, diagnostics)) << gallery.name;
  }
}

}  // namespace
}  // namespace flatlight
