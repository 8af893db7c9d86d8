// SPDX-License-Identifier: Apache-2.0
#include "server/convert/result_convert.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "core/render/field.h"
#include "core/scene/scene.h"
#include "flatlight/v1/result.pb.h"
#include "flatlight/v1/scene.pb.h"
#include "server/convert/scene_convert.h"

namespace flatlight {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pointwise;

// Far from the origin and of an odd size, so that a forgotten change of coordinates shows.
std::shared_ptr<const Scene> FarScene() {
  v1::Scene proto;
  Diagnostics diagnostics;
  return SceneFromJson(R"({"name":"far","plane":{
      "materials":[{"name":"red","lambertian":{"reflectance":[0.5,0,0]}}],
      "curves":[{"name":"floor","segment":{"a":{"x":1000,"y":50},"b":{"x":1012,"y":50}},"material":"red"}]},
      "probes":[{"name":"floor","curve":"floor","count":3},
                {"name":"free","points":[{"position":{"x":1001,"y":53},"normal":{"x":0,"y":-3}}]}]})",
                       proto, diagnostics);
}

Field ThreeChannelField() {
  Field field;
  field.rays = 1234;
  field.probes.resize(2);
  field.probes[0].irradiance = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  field.probes[0].samples = {16, 32, 48};
  field.probes[1].irradiance = {10, 11, 12};
  field.probes[1].gradient = {13, 14, 15};
  return field;
}

TEST(ResultConvertTest, PositionsAndArcLengthAreInWorldUnits) {
  const auto scene = FarScene();
  ASSERT_NE(scene, nullptr);
  v1::ProbeResult out;
  FillProbeGeometry(SceneOutline(*scene), 0, 0, 3, out);
  EXPECT_EQ(out.name(), "floor");
  EXPECT_EQ(out.quantity(), v1::ProbeResult::IRRADIANCE);
  EXPECT_THAT(out.positions(), Pointwise(DoubleNear(1e-9), std::vector<double>{1002, 50, 1006, 50, 1010, 50}));
  EXPECT_THAT(out.normals(), Pointwise(DoubleNear(1e-15), std::vector<double>{0, 1, 0, 1, 0, 1}));
  EXPECT_THAT(out.arc_length(), Pointwise(DoubleNear(1e-9), std::vector<double>{2, 6, 10}));
}

TEST(ResultConvertTest, FreePointsHaveNoArcLength) {
  const auto scene = FarScene();
  v1::ProbeResult out;
  FillProbeGeometry(SceneOutline(*scene), 1, 0, 1, out);
  EXPECT_THAT(out.positions(), Pointwise(DoubleNear(1e-9), std::vector<double>{1001, 53}));
  EXPECT_THAT(out.normals(), ElementsAre(0, -1));
  EXPECT_THAT(out.arc_length(), IsEmpty());
}

TEST(ResultConvertTest, ASliceHasThePointsNamed) {
  const auto scene = FarScene();
  v1::ProbeResult out;
  FillProbeGeometry(SceneOutline(*scene), 0, 1, 2, out);
  FillProbeValues(ThreeChannelField(), 3, 0, 1, 2, out);
  EXPECT_THAT(out.arc_length(), Pointwise(DoubleNear(1e-9), std::vector<double>{6, 10}));
  EXPECT_EQ(out.count(), 2U);
  EXPECT_EQ(out.channels(), 3U);
  EXPECT_THAT(out.irradiance(), ElementsAre(4, 5, 6, 7, 8, 9));
  EXPECT_THAT(out.samples(), ElementsAre(32, 48));
}

TEST(ResultConvertTest, WhatTheFieldLacksIsAbsent) {
  v1::ProbeResult out;
  FillProbeValues(ThreeChannelField(), 3, 0, 0, 3, out);
  EXPECT_THAT(out.standard_error(), IsEmpty());
  EXPECT_THAT(out.gradient(), IsEmpty());
  EXPECT_THAT(out.gradient_error(), IsEmpty());
  EXPECT_THAT(out.hessian(), IsEmpty());
  EXPECT_THAT(out.hessian_error(), IsEmpty());
}

TEST(ResultConvertTest, EveryArrayReachesItsOwnField) {
  Field field;
  field.probes.push_back({{1}, {2}, {3}, {4}, {5}, {6}, {9}, {10}, {7}, {8}, {11}, {12}});
  v1::ProbeResult out;
  FillProbeValues(field, 1, 0, 0, 1, out);
  EXPECT_THAT(out.irradiance(), ElementsAre(1));
  EXPECT_THAT(out.standard_error(), ElementsAre(2));
  EXPECT_THAT(out.gradient(), ElementsAre(3));
  EXPECT_THAT(out.gradient_error(), ElementsAre(4));
  EXPECT_THAT(out.hessian(), ElementsAre(5));
  EXPECT_THAT(out.hessian_error(), ElementsAre(6));
  EXPECT_THAT(out.samples(), ElementsAre(7));
  EXPECT_THAT(out.irradiance_error(), ElementsAre(8));
  EXPECT_THAT(out.rotation_gradient(), ElementsAre(9));
  EXPECT_THAT(out.rotation_gradient_error(), ElementsAre(10));
  EXPECT_THAT(out.estimated_error(), ElementsAre(11));
  EXPECT_THAT(out.estimated_bias(), ElementsAre(12));
}

TEST(ResultConvertTest, AResultHasAllProbes) {
  const auto scene = FarScene();
  Field field = ThreeChannelField();
  v1::RenderResult result = ResultToProto(SceneOutline(*scene), field);
  EXPECT_EQ(result.scene(), "far");
  EXPECT_EQ(result.world_hash(), scene->world_hash());
  EXPECT_EQ(result.probe_hash(), scene->probe_hash());
  ASSERT_EQ(result.probes_size(), 2);
  EXPECT_EQ(result.probes(0).count(), 3U);
  EXPECT_EQ(result.probes(0).positions_size(), 6);
  EXPECT_EQ(result.probes(0).irradiance_size(), 9);
  EXPECT_THAT(result.probes(1).gradient(), ElementsAre(13, 14, 15));
  EXPECT_EQ(result.statistics().rays(), 1234);
  EXPECT_FALSE(result.statistics().has_error_bound());
  EXPECT_FALSE(result.statistics().has_unsampled_points());
  field.probes[0].samples = {16, 0, 0};
  EXPECT_EQ(ResultToProto(SceneOutline(*scene), field).statistics().unsampled_points(), 2);
  field.error_bound = 1e-9;
  EXPECT_EQ(ResultToProto(SceneOutline(*scene), field).statistics().error_bound(), 1e-9);
}

TEST(ResultConvertTest, APictureHasItsPlaceAndNoPoints) {
  v1::Scene proto;
  Diagnostics diagnostics;
  const auto scene = SceneFromJson(R"({"name":"far","plane":{
      "materials":[{"name":"red","lambertian":{"reflectance":[0.5]}}],
      "curves":[{"name":"floor","segment":{"a":{"x":1000,"y":50},"b":{"x":1012,"y":50}},"material":"red"}]},
      "probes":[{"name":"light","fluence":{"min":{"x":1001,"y":51},"max":{"x":1003,"y":54},"width":2,"height":3}}]})",
                                   proto, diagnostics);
  ASSERT_NE(scene, nullptr);
  Field field;
  field.probes.resize(1);
  field.probes[0].irradiance = {1, 2, 3, 4, 5, 6};
  field.probes[0].standard_error = {6, 5, 4, 3, 2, 1};
  const v1::RenderResult result = ResultToProto(SceneOutline(*scene), field);
  const v1::ProbeResult& light = result.probes(0);
  EXPECT_EQ(light.quantity(), v1::ProbeResult::FLUENCE);
  EXPECT_EQ(light.count(), 6u);
  EXPECT_EQ(light.width(), 2u);
  EXPECT_EQ(light.height(), 3u);
  EXPECT_THAT(light.corners(), Pointwise(DoubleNear(1e-9), std::vector<double>{1001, 51, 1003, 54}));
  EXPECT_THAT(light.positions(), IsEmpty());
  EXPECT_THAT(light.normals(), IsEmpty());
  EXPECT_THAT(light.irradiance(), ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_THAT(light.standard_error(), ElementsAre(6, 5, 4, 3, 2, 1));
  EXPECT_EQ(TraitsToProto(scene->traits()).pixels(), 6);
}

TEST(ResultConvertTest, ACameraIsALineOfRadiance) {
  v1::Scene proto;
  Diagnostics diagnostics;
  const auto scene = SceneFromJson(R"({"name":"eye","plane":{
      "materials":[{"name":"red","lambertian":{"reflectance":[0.5]}}],
      "curves":[{"name":"floor","segment":{"a":{"x":0,"y":0},"b":{"x":1,"y":0}},"material":"red"}]},
      "probes":[{"name":"eye","camera":{"position":{"x":0,"y":2},"target":{"x":0,"y":0},"up":{"x":1,"y":0},
                                        "fieldOfView":1,"width":3}}]})",
                                   proto, diagnostics);
  ASSERT_NE(scene, nullptr);
  Field field;
  field.probes.resize(1);
  field.probes[0].irradiance = {1, 2, 3};
  const v1::ProbeResult eye = ResultToProto(SceneOutline(*scene), field).probes(0);
  EXPECT_EQ(eye.quantity(), v1::ProbeResult::RADIANCE);
  EXPECT_EQ(eye.count(), 3u);
  EXPECT_EQ(eye.width(), 3u);
  EXPECT_EQ(eye.height(), 1u);
  EXPECT_THAT(eye.positions(), Pointwise(DoubleNear(1e-12), std::vector<double>{0, 2, 0, 2, 0, 2}));
  ASSERT_EQ(eye.normals_size(), 6);
  EXPECT_NEAR(eye.normals(3), -1, 1e-12);
  EXPECT_GT(eye.normals(4), 0.2);
}

TEST(ResultConvertTest, CamerasWantTheirNumbers) {
  v1::Scene proto;
  Diagnostics diagnostics;
  SceneFromJson(R"({"name":"eye","plane":{"materials":[{"name":"red","lambertian":{"reflectance":[0.5]}}],
      "curves":[{"name":"floor","segment":{"a":{"x":0,"y":0},"b":{"x":1,"y":0}},"material":"red"}]},
      "probes":[{"name":"eye","camera":{"position":{"x":0,"y":2},"heigth":1,"width":3}}]})",
                proto, diagnostics);
  std::vector<std::string> paths;
  for (const Diagnostic& diagnostic : diagnostics.kept()) paths.push_back(diagnostic.path);
  EXPECT_THAT(paths, testing::IsSupersetOf({"probes[0].camera.heigth"}));
}

TEST(ResultConvertTest, EndReasons) {
  EXPECT_EQ(EndReasonToProto(EndReason::kConverged), v1::CONVERGED);
  EXPECT_EQ(EndReasonToProto(EndReason::kSamplesDone), v1::SAMPLES_DONE);
  EXPECT_EQ(EndReasonToProto(EndReason::kTargetReached), v1::TARGET_REACHED);
  EXPECT_EQ(EndReasonToProto(EndReason::kTimeLimit), v1::TIME_LIMIT);
  EXPECT_EQ(EndReasonToProto(EndReason::kAccuracyLimit), v1::ACCURACY_LIMIT);
}

TEST(ResultConvertTest, Traits) {
  const auto scene = FarScene();
  const v1::SceneTraits traits = TraitsToProto(scene->traits());
  EXPECT_EQ(traits.curves(), 1);
  EXPECT_EQ(traits.elements(), 1);
  EXPECT_EQ(traits.emitters(), 0);
  EXPECT_EQ(traits.probe_points(), 4);
  EXPECT_EQ(traits.max_reflectance(), 0.5);
  EXPECT_FALSE(traits.grey());
}

}  // namespace
}  // namespace flatlight
