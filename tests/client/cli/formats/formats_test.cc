// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

#include "client/cli/formats/csv.h"
#include "client/cli/formats/enum_names.h"
#include "client/cli/formats/json_text.h"
#include "client/cli/formats/npy.h"
#include "client/cli/formats/result_shape.h"
#include "flatlight/v1/settings.pb.h"
#include "tests/client/cli/formats/sample_result.h"

namespace flatlight {
namespace {

using ::testing::HasSubstr;

TEST(Json, ComesBackTheSame) {
  v1::RenderResult result;
  result.set_scene("a \"quoted\" {name}, [here]: \\");
  result.set_end_reason(v1::SAMPLES_DONE);
  AddProbe(result, "floor", 100, 3);
  AddProbe(result, "nothing", 0);
  result.mutable_statistics()->set_rays(0);
  const std::string json = ToJson(result);
  const auto back = ResultFromJson(json, "test");
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(back->SerializeAsString(), result.SerializeAsString());
  EXPECT_THAT(json, HasSubstr("\n  \"endReason\": \"SAMPLES_DONE\",\n"));
  EXPECT_THAT(json, HasSubstr("\n      \"positions\": [0,0,1,0,"));
  EXPECT_THAT(json, HasSubstr("\"rays\": 0"));  // Set, so there.
  EXPECT_THAT(json, HasSubstr("\"count\": 0"));
  EXPECT_THAT(json, Not(HasSubstr("gradient")));  // Not set.
}

TEST(Json, EmptyObjectsAndArrays) {
  EXPECT_EQ(LayOutJson(R"({"a":{},"b":[],"c":["x"],"d":[{"e":"}\"]"}]})"),
            "{\n  \"a\": {},\n  \"b\": [],\n  \"c\": [\n    \"x\"\n  ],\n  \"d\": [\n    {\n      \"e\": \"}\\\"]\"\n"
            "    }\n  ]\n}\n");
}

TEST(Json, ResultsOfLaterVersionsAndOfOthersAreRead) {
  const auto result = ResultFromJson(R"({"novelty": {"a": 1}, "probes": [{"name": "p", "irradiance": [1, 2]}]})", "x");
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(result->probes(0).count(), 2U);
  EXPECT_EQ(result->probes(0).channels(), 1U);
}

TEST(Json, WhatIsNoResultIsRefused) {
  for (const char* json :
       {"", "nonsense", "[]", "{}", R"({"probes": []})", R"({"probes": [{"irradiance": ["NaN"]}]})",
        R"({"probes": [{"count": 3, "irradiance": [1]}]})", R"({"probes": [{"channels": 2, "irradiance": [1, 2]}]})",
        R"({"probes": [{"channels": 0, "irradiance": [1]}]})",
        R"({"probes": [{"irradiance": [1], "positions": [1]}]})"}) {
    const auto result = ResultFromJson(json, "file.json");
    EXPECT_FALSE(result.ok()) << json;
    EXPECT_THAT(std::string(result.status().message().data(), result.status().message().size()),
                HasSubstr("file.json"));
  }
}

TEST(ResultShape, NamesTheBadNumber) {
  v1::RenderResult result;
  AddProbe(result, "good", 2);
  v1::ProbeResult& probe = AddProbe(result, "bad", 3);
  EXPECT_EQ(FindResultDefect(result), "");
  probe.set_irradiance(2, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(FindResultDefect(result), "probes[1].irradiance[2] is nan");
  probe.set_irradiance(2, 1);
  probe.add_gradient(1);
  EXPECT_THAT(FindResultDefect(result), HasSubstr("probes[1].gradient has 1 value"));
}

TEST(ResultShape, PicturesAreAsLargeAsTheySay) {
  v1::RenderResult result;
  v1::ProbeResult& probe = AddProbe(result, "picture", 6);
  probe.set_width(3);
  probe.set_height(2);
  EXPECT_EQ(FindResultDefect(result), "");
  probe.set_height(3);
  EXPECT_EQ(FindResultDefect(result), "probes[0].count is 6: must be width * height, 3 * 3");
}

TEST(Csv, HasOnlyTheColumnsThatExist) {
  v1::RenderResult result;
  AddProbe(result, "a, \"b\"", 2);
  v1::ProbeResult& free = AddProbe(result, "free", 1);
  free.clear_arc_length();
  free.add_standard_error(0.25);
  EXPECT_EQ(ResultToCsv(result, [] { return false; }),
            "probe,index,x,y,nx,ny,arcLength,irradiance,standardError\n"
            "\"a, \"\"b\"\"\",0,0,0,0,1,0.5,1,\n"
            "\"a, \"\"b\"\"\",1,1,0,0,1,1.5,0.5,\n"
            "free,0,0,0,0,1,,1,0.25\n");
}

TEST(Csv, PointsWithoutSamplesHaveNoValues) {
  v1::RenderResult result;
  v1::ProbeResult& probe = AddProbe(result, "floor", 2);
  probe.set_irradiance(1, 0);
  for (const double error : {0.5, 0.0}) probe.add_standard_error(error);
  for (const double samples : {16, 0}) probe.add_samples(samples);
  EXPECT_EQ(ResultToCsv(result, [] { return false; }),
            "probe,index,x,y,nx,ny,arcLength,irradiance,standardError,samples\n"
            "floor,0,0,0,0,1,0.5,1,0.5,16\nfloor,1,1,0,0,1,1.5,,,0\n");
}

TEST(Csv, ColourHasThreeColumns) {
  v1::RenderResult result;
  AddProbe(result, "p", 1, 3);
  EXPECT_EQ(ResultToCsv(result, [] { return false; }),
            "probe,index,x,y,nx,ny,arcLength,irradianceR,irradianceG,irradianceB\n"
            "p,0,0,0,0,1,0.5,1,0.5,0.3333333333333333\n");
}

TEST(Npy, HeaderIsAlignedAndRowsFollow) {
  v1::RenderResult result;
  AddProbe(result, "p", 2, 3);
  AddProbe(result, "q", 1, 3).clear_arc_length();
  const std::string npy = ResultToNpy(result, [] { return false; });
  ASSERT_EQ(npy.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t data = 10 + static_cast<unsigned char>(npy[8]) + 256U * static_cast<unsigned char>(npy[9]);
  EXPECT_EQ(data % 64, 0U);
  const std::string header = npy.substr(10, data - 10);
  EXPECT_EQ(header.back(), '\n');
  EXPECT_THAT(header, HasSubstr("('probe', '<i4'), ('index', '<i4'), ('x', '<f8')"));
  EXPECT_THAT(header, HasSubstr("('irradiance', '<f8', (3,))"));
  EXPECT_THAT(header, HasSubstr("'shape': (3,)"));
  const std::size_t row = 2 * 4 + (5 + 3) * 8;
  ASSERT_EQ(npy.size() - data, 3 * row);
  double blue = 0, missing = 0;
  std::memcpy(&blue, npy.data() + data + row + row - 8, 8);
  EXPECT_EQ(blue, 1.0 / 6);
  std::memcpy(&missing, npy.data() + data + 2 * row + 8 + 4 * 8, 8);
  EXPECT_TRUE(std::isnan(missing));
}

TEST(EnumNames, ComeFromTheApi) {
  const auto& type = *v1::Settings::Method_descriptor();
  EXPECT_EQ(OptionName(v1::Settings::PATH_TRACING), "path-tracing");
  EXPECT_EQ(OptionValue(type, "exact"), v1::Settings::EXACT);
  EXPECT_EQ(OptionValue(type, "EXACT"), std::nullopt);
  EXPECT_EQ(OptionValue(type, "method-unspecified"), std::nullopt);
  EXPECT_THAT(OptionNames(type), ::testing::ElementsAre("exact", "path-tracing", "ray-tracing", "reference",
                                                        "irradiance-caching", "photon-mapping"));
}

}  // namespace
}  // namespace flatlight
