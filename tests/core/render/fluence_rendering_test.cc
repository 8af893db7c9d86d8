// SPDX-License-Identifier: Apache-2.0
// Pictures of light, against closed forms and against path tracing.
#include "core/render/fluence_rendering.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "core/render/skips.h"
#include "tests/support/transport/honest_errors.h"
#include "tests/support/transport/render.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kFullTurn = 2 * kPi;

// A square pixel of a scene, and what its fluence is around a point.
struct Pixel {
  Point2 center;
  double side = 0.1;
  std::function<double(Point2)> fluence;

  // By Gauss' rule of three points in both directions.
  double Mean() const {
    const double nodes[] = {-std::sqrt(0.6), 0, std::sqrt(0.6)}, weights[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    double mean = 0;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const Point2 at = center + Vector2{0.5 * side * nodes[i], 0.5 * side * nodes[j]};
        mean += weights[i] * weights[j] * fluence(at);
      }
    }
    return mean;
  }
};

// Pictures of one pixel, over many seeds: the mean is right, and the stated errors tell how far off each is.
void ExpectFluence(SceneMaker maker, const Pixel& pixel, std::uint32_t samples = 1024,
                   std::optional<std::uint32_t> max_bounces = {}) {
  const Vector2 half{0.5 * pixel.side, 0.5 * pixel.side};
  const auto scene = maker.Picture(pixel.center - half, pixel.center + half, 1, 1).Build();
  const double truth = pixel.Mean();
  HonestErrors errors, wrong;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    Settings settings = Sampled(samples, seed);
    settings.max_bounces = max_bounces;
    const ProbeField field = Render(scene, settings).field->probes.back();
    errors.Add(field.irradiance[0], truth, field.standard_error[0]);
    wrong.Add(1.1 * field.irradiance[0], truth, field.standard_error[0]);
  }
  EXPECT_TRUE(errors.Unbiased()) << errors.MeanZ();
  EXPECT_TRUE(errors.RightSize()) << errors.MeanSquareZ();
  EXPECT_FALSE(wrong.Unbiased()) << "a tenth more light must be noticed";
}

Pixel Constant(Point2 center, double fluence) {
  return {center, 0.1, [fluence](Point2) { return fluence; }};
}

TEST(FluenceTest, PointLight) {
  SceneMaker maker;
  maker.Light(PointLightDescription{{0.2, 0.1}, {3 * kFullTurn}});
  ExpectFluence(maker, {{0.5, 0.5}, 0.1, [](Point2 p) { return 3 / Length(p - Point2{0.2, 0.1}); }});
}

// Half of the spot's edge runs through the pixel.
TEST(FluenceTest, SpotFades) {
  SceneMaker maker;
  maker.Light(SpotLightDescription{{0, 0}, {1, 0}, {3 * 0.8}, 0.1, 0.7});
  const auto share = [](double angle) {
    const double t = (0.7 - angle) / 0.6;
    return t * t * (3 - 2 * t);
  };
  ExpectFluence(maker,
                {{1, 0.4}, 0.1, [&](Point2 p) { return 3 * share(std::atan2(p.y, p.x)) / std::hypot(p.x, p.y); }});
}

TEST(FluenceTest, GlowingDisc) {
  SceneMaker maker;
  maker.Arc("disc", {{0, 0}, 0.3, 0, -kFullTurn}, {.radiance = {2}});
  ExpectFluence(maker, {{0.6, 0.4}, 0.1, [](Point2 p) { return 4 * std::asin(0.3 / std::hypot(p.x, p.y)); }});
}

TEST(FluenceTest, DirectionalLightAndAMirror) {
  SceneMaker maker;
  maker.Light(DirectionalLightDescription{{0, -1}, {5}});
  maker.Segment("mirror", {2, -2}, {-2, -2}, {.material = MirrorDescription{{0.8}}});
  ExpectFluence(maker, Constant({0.3, -1}, 5 * 1.8));
}

TEST(FluenceTest, SkyBesideAWall) {
  SceneMaker maker;
  maker.Environment({2}).Segment("wall", {1, -1}, {1, 1});
  ExpectFluence(maker, {{0, 0}, 0.1, [](Point2 p) {
                          return 2 * (kFullTurn - std::atan2(1 - p.y, 1 - p.x) - std::atan2(1 + p.y, 1 - p.x));
                        }});
}

TEST(FluenceTest, Furnace) {
  ExpectFluence(SquareRoom({.reflectance = {0.6}, .radiance = {1}}, 1), Constant({0.9, -0.9}, kFullTurn * 2.5));
  ExpectFluence(SquareRoom({.reflectance = {0.6}, .radiance = {1}}, 1), Constant({0, 0.3}, kFullTurn * 1.6), 1024, 1);
}

// Radiance in glass is n times that outside; from farther out than 1 / n of a ball's radius not all directions lead
// out.
TEST(FluenceTest, GlassInAFurnace) {
  SceneMaker maker = SquareRoom({.reflectance = {0.5}, .radiance = {1}}, 1);
  maker.Arc("ball", {{0, 0}, 0.8, 0, -kFullTurn}, {.material = DielectricDescription{1.5}});
  ExpectFluence(maker, {{0.1, 0.2}, 0.2, [](Point2) { return kFullTurn * 1.5 * 2; }}, 256);
  ExpectFluence(
      maker, {{0.67, 0}, 0.2, [](Point2 p) { return 4 * 1.5 * 2 * std::asin(0.8 / 1.5 / std::hypot(p.x, p.y)); }}, 256);
}

// A point sees the same light: fluence is half the integral of irradiance over all orientations.
TEST(FluenceTest, AgreesWithPathTracingAmongAllMaterials) {
  constexpr int kNormals = 48;
  SceneMaker maker;
  maker.Polyline("room", {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, true, {.reflectance = {0.5}});
  maker.Arc("lamp", {{-0.7, 0.7}, 0.1, 0, -kFullTurn}, {.radiance = {10}});
  maker.Arc("ball", {{0.3, 0.3}, 0.2, 0, -kFullTurn}, {.material = DielectricDescription{1.5}});
  maker.Segment("gloss", {0.95, 0.9}, {0.95, -0.9}, {.material = PhongDescription{{0.8}, 20}});
  maker.Segment("metal", {0.9, -0.95}, {-0.9, -0.95}, {.material = ConductorDescription{{0.9}, 0.4}});
  const Point2 center{0.2, -0.3};
  SceneMaker points = maker;
  for (int i = 0; i < kNormals; ++i) {
    const double angle = kFullTurn * i / kNormals;
    points.PointProbe(center, {std::cos(angle), std::sin(angle)});
  }
  const Ended traced = Render(points.Build(), Sampled(1024));
  double truth = 0, variance = 0;
  for (const ProbeField& probe : traced.field->probes) {
    truth += kPi / kNormals * probe.irradiance[0];
    variance += std::pow(kPi / kNormals * probe.standard_error[0], 2);
  }
  const Vector2 half{0.02, 0.02};
  const auto scene = maker.Picture(center - half, center + half, 1, 1).Build();
  const ProbeField field = Render(scene, Sampled(1u << 20)).field->probes.back();
  const double error = std::sqrt(variance + field.standard_error[0] * field.standard_error[0]);
  EXPECT_NEAR(field.irradiance[0], truth, 5 * error);
  EXPECT_LT(error, 0.015 * truth);
}

TEST(FluenceTest, ManyPixelsAndColours) {
  const auto scene = SquareRoom({.reflectance = {0.2, 0.5, 0.7}, .radiance = {1, 3, 0.5}}, 1)
                         .Picture({-0.8, -0.5}, {0.8, 0.5}, 16, 10)
                         .Build();
  const ProbeField field = Render(scene, Sampled(4096)).field->probes.back();
  ASSERT_EQ(field.irradiance.size(), 480u);
  const double truth[] = {kFullTurn * 1 / 0.8, kFullTurn * 3 / 0.5, kFullTurn * 0.5 / 0.3};
  for (std::size_t i = 0; i < 480; ++i)
    EXPECT_NEAR(field.irradiance[i], truth[i % 3], 6.5 * field.standard_error[i]) << i;
}

TEST(FluenceTest, RowsBeginBelow) {
  SceneMaker maker;
  maker.Light(PointLightDescription{{0, 0}, {kFullTurn}});
  maker.Segment("roof", {-10, 1}, {10, 1});
  const auto scene = maker.Picture({1, 0.5}, {2, 1.5}, 1, 2).Build();
  const ProbeField field = Render(scene, Sampled(256)).field->probes[0];
  EXPECT_GT(field.irradiance[0], 0.3);
  EXPECT_EQ(field.irradiance[1], 0);
}

// Points and pictures of one job, the same as each alone.
TEST(FluenceTest, PointsBesideAPicture) {
  const SceneMaker room = SquareRoom({.reflectance = {0.6}, .radiance = {1}}, 2);
  SceneMaker both = room;
  both.Picture({-0.5, -0.5}, {0.5, 0.5}, 4, 4);
  SceneDescription alone = both.description();
  alone.probes.erase(alone.probes.begin(), alone.probes.end() - 1);
  Diagnostics diagnostics;
  const auto picture = BuildScene(alone, diagnostics);
  ASSERT_NE(picture, nullptr);
  const Ended ended = Render(both.Build(), Sampled(64));
  EXPECT_EQ(ended.field->probes[4].irradiance, Render(picture, Sampled(64)).field->probes[0].irradiance);
  EXPECT_EQ(ended.field->probes[2].irradiance, Render(room.Build(), Sampled(64)).field->probes[2].irradiance);
}

TEST(FluenceTest, SameBitsForAnyThreadsAndSlices) {
  SceneMaker maker = FurnishedRoom(false, 3);
  const auto scene = maker.Picture({0, 0}, {4, 3}, 30, 20).Build();
  const Settings settings = Sampled(64);
  const std::uint64_t one = HashOf(*Render(scene, settings).field);
  EXPECT_EQ(HashOf(*Render(scene, settings, 2).field), one);
  EXPECT_EQ(HashOf(*Render(scene, settings, 7, std::chrono::microseconds(50)).field), one);
  EXPECT_NE(HashOf(*Render(scene, Sampled(64, 1)).field), one);
}

TEST(FluenceTest, SkipsChangeNothing) {
  SceneMaker maker;
  maker.Arc("lamp", {{0, 0}, 0.3, 0, -kFullTurn}, {.radiance = {2}}).Segment("wall", {1, -1}, {1, 1});
  const auto scene = maker.Picture({-1, -1}, {1, 1}, 5, 5).Build();
  Settings settings = Sampled(256);
  const std::uint64_t hash = HashOf(*Render(scene, settings).field);
  for (const std::string& name : SkipNames()) {
    settings.no_skip = {name};
    EXPECT_EQ(HashOf(*Render(scene, settings).field), hash) << name;
  }
  const Plan plan = PlanFor(*scene, Sampled(256));
  EXPECT_TRUE(plan.Takes(skip::kColour) && plan.Takes(skip::kBounces));
  EXPECT_FALSE(plan.Takes(skip::kVisibility)) << "there are no shadow tests";
}

TEST(FluenceTest, DarknessEndsAtOnce) {
  SceneMaker maker = SquareRoom({.reflectance = {0.6}}, 1);
  const Ended ended = Render(maker.Picture({-1, -1}, {1, 1}, 3, 3).Build(), Sampled(1u << 20));
  EXPECT_EQ(ended.field->rays, 0);
  EXPECT_EQ(ended.field->probes.back().irradiance, std::vector<double>(9, 0.0));
  EXPECT_EQ(ended.field->probes.back().standard_error, std::vector<double>(9, 0.0));
}

TEST(FluenceTest, StopsAtItsTarget) {
  const auto scene = SquareRoom({.reflectance = {0.6}, .radiance = {1}}, 1).Picture({-1, -1}, {1, 1}, 4, 4).Build();
  Settings settings;
  settings.method = Method::kPathTracing;
  settings.target_error = 0.02;
  settings.derivatives = Derivatives::kNone;
  const Ended ended = Render(scene, settings);
  EXPECT_EQ(ended.reason, EndReason::kTargetReached);
  const ProbeField& field = ended.field->probes.back();
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_LE(field.standard_error[i], 0.02 * field.irradiance[i]);
    EXPECT_NEAR(field.irradiance[i], kFullTurn * 2.5, 6.5 * field.standard_error[i]);
  }
}

}  // namespace
}  // namespace flatlight
