// SPDX-License-Identifier: Apache-2.0
// What cameras in the plane see, against closed forms, and exact light against path tracing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "tests/support/transport/honest_errors.h"
#include "tests/support/transport/render.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;

Settings Exact() {
  Settings settings;
  settings.method = Method::kExact;
  return settings;
}

// A camera at the origin that looks along x, its line from left to right: where the borders of pixels are.
struct Eye {
  double field_of_view = 1.8;
  std::uint32_t width = 9;

  double Border(std::uint32_t i) const {
    return std::atan(std::tan(0.5 * field_of_view) * (1 - 2.0 * i / width));  // Counter-clockwise.
  }
  SceneMaker& AddTo(SceneMaker& maker) const { return maker.Camera({0, 0}, {1, 0}, field_of_view, width); }
  // The share of a pixel between two angles.
  double Share(std::uint32_t i, double low, double high) const {
    const double from = Border(i + 1), to = Border(i);
    return std::max(0.0, std::min(to, high) - std::max(from, low)) / (to - from);
  }
};

TEST(CameraTest, SeesEachPixelsShareOfALamp) {
  const Eye eye;
  SceneMaker maker;
  maker.Segment("lamp", {1, -0.2}, {1, 0.33}, {.radiance = {3}}).Segment("screen", {0.5, 0.1}, {0.5, 0.12});
  maker.Arc("disc", {{2, -1.5}, 0.4, 0, -kFullTurn}, {.radiance = {2}});
  maker.Light(PointLightDescription{{0.7, 0}, {100}});  // Is not seen.
  const ProbeField field = Render(eye.AddTo(maker).Build(), Exact()).field->probes[0];
  ASSERT_EQ(field.irradiance.size(), 9u);
  EXPECT_TRUE(field.gradient.empty());
  const double disc = -std::atan2(1.5, 2), half = std::asin(0.4 / 2.5);
  for (std::uint32_t i = 0; i < 9; ++i) {
    const double lamp = eye.Share(i, std::atan(-0.2), std::atan(0.33)) - eye.Share(i, std::atan(0.2), std::atan(0.24));
    EXPECT_NEAR(field.irradiance[i], 3 * lamp + 2 * eye.Share(i, disc - half, disc + half), 1e-12) << i;
  }
}

TEST(CameraTest, SeesTheSkyBesideAWall) {
  const Eye eye;
  SceneMaker maker;
  maker.Environment({2}).Segment("wall", {1, -0.2}, {1, 0.33});
  const ProbeField field = Render(eye.AddTo(maker).Build(), Exact()).field->probes[0];
  for (std::uint32_t i = 0; i < 9; ++i)
    EXPECT_NEAR(field.irradiance[i], 2 - 2 * eye.Share(i, std::atan(-0.2), std::atan(0.33)), 1e-12) << i;
}

// The pixels of many seeds against what they must show.
void ExpectSeen(SceneMaker maker, const Eye& eye, const std::function<double(std::uint32_t)>& truth,
                std::optional<std::uint32_t> max_bounces = {}) {
  const auto scene = eye.AddTo(maker).Build();
  HonestErrors errors, wrong;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    Settings settings = Sampled(64, seed);
    settings.max_bounces = max_bounces;
    const ProbeField field = Render(scene, settings).field->probes.back();
    for (std::uint32_t i = 0; i < eye.width; ++i) {
      errors.Add(field.irradiance[i], truth(i), field.standard_error[i]);
      wrong.Add(1.1 * field.irradiance[i], truth(i), field.standard_error[i]);
    }
  }
  EXPECT_TRUE(errors.Unbiased()) << errors.MeanZ();
  EXPECT_LT(errors.MeanSquareZ(), 1.3);
  EXPECT_FALSE(wrong.Unbiased()) << "a tenth more light must be noticed";
}

TEST(CameraTest, Furnace) {
  const SceneMaker room = SquareRoom({.reflectance = {0.6}, .radiance = {1}}, 1);
  ExpectSeen(room, Eye(), [](std::uint32_t) { return 2.5; });
  ExpectSeen(
      room, Eye(), [](std::uint32_t) { return 1.6; }, 1);
}

// A mirror shows the lamp where its image is, 0.8 times as bright.
TEST(CameraTest, LampInAMirror) {
  const Eye eye;
  SceneMaker maker;
  maker.Segment("mirror", {1, 2}, {1, -2}, {.material = MirrorDescription{{0.8}}});
  maker.Segment("lamp", {-1, 0.5}, {-1, -0.7}, {.radiance = {4}, .two_sided = true});
  const double low = std::atan(-0.7 / 3), high = std::atan(0.5 / 3);
  ExpectSeen(maker, {0.5, 5}, [&](std::uint32_t i) { return 4 * 0.8 * Eye{0.5, 5}.Share(i, low, high); });
}

// In glass radiance is n times what it is outside.
TEST(CameraTest, InsideOfGlass) {
  SceneMaker maker = SquareRoom({.reflectance = {0.5}, .radiance = {1}}, 1);
  maker.Arc("ball", {{0, 0}, 0.8, 0, -kFullTurn}, {.material = DielectricDescription{1.5}});
  ExpectSeen(maker, Eye(), [](std::uint32_t) { return 3.0; });
}

TEST(CameraTest, ExactAgreesWithPathTracing) {
  SceneMaker maker = FurnishedRoom(false, 1);
  SceneDescription description = maker.Camera({1.1, 0.3}, {2, 3}, 2.5, 64).description();
  description.probes.erase(description.probes.begin(), description.probes.end() - 1);
  Diagnostics diagnostics;
  const auto scene = BuildScene(description, diagnostics);
  ASSERT_NE(scene, nullptr);
  Settings exact = Exact(), sampled = Sampled(1024);
  exact.max_bounces = sampled.max_bounces = 0;
  const ProbeField truth = Render(scene, exact).field->probes[0], seen = Render(scene, sampled).field->probes[0];
  ASSERT_EQ(truth.irradiance.size(), 192u);
  double light = 0;
  for (std::size_t i = 0; i < truth.irradiance.size(); ++i) {
    EXPECT_NEAR(seen.irradiance[i], truth.irradiance[i], 5 * seen.standard_error[i]) << i;
    light += truth.irradiance[i];
  }
  EXPECT_GT(light, 1);
}

TEST(CameraTest, SameBitsForAnyThreads) {
  SceneMaker maker = FurnishedRoom(false, 3);
  const auto scene = maker.Camera({1.1, 0.3}, {2, 3}, 2.5, 64).Build();
  EXPECT_EQ(HashOf(*Render(scene, Sampled(64)).field), HashOf(*Render(scene, Sampled(64), 3).field));
}

TEST(CameraTest, IsRefusedWhereItMeansNothing) {
  SceneMaker maker = SquareRoom({.radiance = {1}}, 1);
  const auto scene = Eye().AddTo(maker).Build();
  EXPECT_EQ(PlanFor(*scene, {}).settings.method, Method::kExact);
  for (const Method method : {Method::kRayTracing, Method::kReference}) {
    Settings settings;
    settings.method = method;
    Diagnostics diagnostics;
    EXPECT_FALSE(MakePlan(*scene, settings, diagnostics).has_value());
    ASSERT_GE(diagnostics.count(), 1u);
    EXPECT_NE(diagnostics.kept()[0].message.find("camera"), std::string::npos);
  }
}

}  // namespace
}  // namespace flatlight
