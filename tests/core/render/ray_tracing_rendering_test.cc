// SPDX-License-Identifier: Apache-2.0
#include "core/render/ray_tracing_rendering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>

#include "core/render/skips.h"
#include "tests/support/transport/honest_errors.h"
#include "tests/support/transport/render.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

Settings Branching(std::uint32_t samples, std::uint32_t seed = 0) {
  Settings settings;
  settings.method = Method::kRayTracing;
  settings.samples = samples;
  settings.seed = seed;
  return settings;
}

// Light is the same everywhere: derivatives are 0 but for noise.
TEST(RayTracingTest, StatedErrorsTellTheTruthInAFurnace) {
  const auto scene = SquareRoom({.reflectance = {0.6}, .radiance = {1}}, 2).Build();
  for (const Formulation formulation : {Formulation::kStratified, Formulation::kPolyline, Formulation::kArcLength}) {
    HonestErrors irradiance, gradient, rotation, wrong;
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
      Settings settings = Branching(128, seed);
      settings.formulation = formulation;
      const Ended ended = Render(scene, settings);
      for (const ProbeField& probe : ended.field->probes) {
        for (std::size_t i = 0; i < probe.irradiance.size(); ++i) {
          irradiance.Add(probe.irradiance[i], 5, probe.standard_error[i]);
          wrong.Add(1.05 * probe.irradiance[i], 5, probe.standard_error[i]);
          gradient.Add(probe.gradient[i], 0, probe.gradient_error[i]);
          rotation.Add(probe.rotation_gradient[i], 0, probe.rotation_gradient_error[i]);
        }
      }
    }
    EXPECT_EQ(irradiance.count(), 320u);
    EXPECT_TRUE(irradiance.Unbiased()) << irradiance.MeanZ();
    EXPECT_TRUE(irradiance.RightSize()) << irradiance.MeanSquareZ();
    EXPECT_FALSE(wrong.Unbiased()) << "a twentieth more light must be noticed";
    EXPECT_TRUE(gradient.Unbiased()) << gradient.MeanZ();
    EXPECT_LT(gradient.MeanSquareZ(), 1.6);
    EXPECT_TRUE(rotation.Unbiased()) << rotation.MeanZ();
    EXPECT_LT(rotation.MeanSquareZ(), 1.6);
  }
}

// Rays along a hollow receiver meet it ever nearer: no reason to doubt the others.
TEST(RayTracingTest, StatedErrorsTellTheTruthInARoundFurnace) {
  SceneMaker maker;
  maker.Arc("ring", {{0, 0}, 1, 0, 2 * std::numbers::pi}, {.reflectance = {0.6}, .radiance = {1}}).Probe("ring", 4);
  const auto scene = maker.Build();
  HonestErrors gradient;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    const ProbeField probe = Render(scene, Branching(1024, seed)).field->probes[0];
    for (std::size_t i = 0; i < 4; ++i) gradient.Add(probe.gradient[i], 0, probe.gradient_error[i]);
  }
  EXPECT_TRUE(gradient.Unbiased()) << gradient.MeanZ();
  EXPECT_TRUE(gradient.RightSize()) << gradient.MeanSquareZ();
}

TEST(RayTracingTest, AgreesWithPathTracingAmongAllMaterialsAndLights) {
  const auto scene = RoomOfAllMaterials().Build();
  const ProbeField paths = Render(scene, Sampled(16384)).field->probes[0];
  const ProbeField trees = Render(scene, Branching(2048)).field->probes[0];
  double sum = 0;
  for (std::size_t i = 0; i < paths.irradiance.size(); ++i) {
    const double z =
        (trees.irradiance[i] - paths.irradiance[i]) / std::hypot(trees.standard_error[i], paths.standard_error[i]);
    EXPECT_LT(std::abs(z), 6) << i;
    sum += z * z / static_cast<double>(paths.irradiance.size());
  }
  EXPECT_LT(sum, 1.6);
}

// Two lights without a surface, a sky and a bounce: what path tracing finds, and its differences.
TEST(RayTracingTest, GradientIsThatOfTheIrradiance) {
  constexpr double kStep = 0.05;
  SceneMaker maker;
  maker.Segment("floor", {0, 0}, {2, 0}, {.reflectance = {0.6}})
      .Segment("wall", {0, 1.5}, {0, 0}, {.reflectance = {0.8}});
  maker.Segment("lamp", {1.6, 1}, {0.8, 1.2}, {.radiance = {2}});
  maker.Light(PointLightDescription{{1, 0.8}, {2}}).Environment({0.3});
  SceneMaker points = maker;
  for (const double x : {0.5 - 2 * kStep, 0.5 - kStep, 0.5 + kStep, 0.5 + 2 * kStep}) points.PointProbe({x, 0}, {0, 1});
  const auto traced = Render(points.Build(), Sampled(1u << 17)).field;
  const auto value = [&](std::size_t i) { return traced->probes[i].irradiance[0]; };
  double variance = 0;
  for (const ProbeField& probe : traced->probes) variance += probe.standard_error[0] * probe.standard_error[0];
  const double difference = (8 * (value(2) - value(1)) - (value(3) - value(0))) / (12 * kStep);
  const auto scene = maker.PointProbe({0.5, 0}, {0, 1}).Build();
  for (const Formulation formulation : {Formulation::kStratified, Formulation::kPolyline}) {
    Settings settings = Branching(1u << 14);
    settings.formulation = formulation;
    const ProbeField field = Render(scene, settings).field->probes[0];
    EXPECT_NEAR(field.gradient[0], difference,
                5 * std::hypot(field.gradient_error[0], 8 * std::sqrt(variance / 2) / (12 * kStep)) + 2e-3);
    EXPECT_LT(field.gradient_error[0], 0.02);
    EXPECT_GT(std::abs(difference), 0.3);
  }
}

// A turning normal: irradiance is a function of it alone whose first two harmonics tell the derivative, found by path
// tracing at normals aside. Near a corner, where what the horizon shows varies along the wall.
// A plate that points see edge-on, exactly or nearly, so that no ray meets it, or few do: as the points move on, its
// lit side or its dark one comes into sight. In direct light the gradient is exact; of what is reflected it has errors.
TEST(RayTracingTest, GradientKnowsPiecesThatAreSeenEdgeOn) {
  SceneMaker maker;
  maker.Polyline("room", {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, true, {.reflectance = {0.5}});
  maker.Segment("lamp", {0.8, 0.95}, {0.2, 0.95}, {.reflectance = {0}, .radiance = {3}});
  maker.Segment("plate", {0.3, 0.45}, {0.7, 0.45}, {.reflectance = {0.8}, .radiance = {0.5}});
  for (const double y : {0.43, 0.449, 0.45, 0.4501, 0.47}) {
    maker.PointProbe({0, y}, {1, 0});
    maker.PointProbe({1, y}, {-1, 0});
  }
  const auto scene = maker.Build();
  for (const Formulation formulation : {Formulation::kStratified, Formulation::kPolyline}) {
    for (const bool direct : {true, false}) {
      Settings truth_settings, settings = Branching(1024);
      truth_settings.method = direct ? Method::kExact : Method::kReference;
      truth_settings.derivatives = settings.derivatives = Derivatives::kGradient;
      settings.formulation = formulation;
      if (direct) truth_settings.max_bounces = settings.max_bounces = 0;
      const std::shared_ptr<const Field> truth = Render(scene, truth_settings).field;
      const std::shared_ptr<const Field> rays = Render(scene, settings).field;
      for (std::size_t p = 0; p < truth->probes.size(); ++p) {
        const ProbeField &a = rays->probes[p], &b = truth->probes[p];
        // 20 values, 4 times: one of t_15 is beyond 6 in 10^5.
        EXPECT_NEAR(a.gradient[0], b.gradient[0], direct ? 1e-9 : 6 * a.gradient_error[0]) << p << direct;
        EXPECT_LT(a.gradient_error[0], 0.5);
      }
    }
  }
}

TEST(RayTracingTest, DerivativesTakeFewRaysMore) {
  SceneMaker maker = SquareRoom({.reflectance = {0.5}}, 4);
  maker.Segment("lamp", {0.3, 0.9}, {-0.3, 0.9}, {.radiance = {3}});
  maker.Polyline("box", {{0.1, -0.5}, {0.1, 0}, {-0.4, 0}, {-0.4, -0.5}}, true, {.reflectance = {0.5}});
  const auto scene = maker.Build();
  Settings settings = Branching(256);
  settings.max_bounces = 3;
  settings.derivatives = Derivatives::kNone;
  const double alone = Render(scene, settings).field->rays;
  settings.derivatives = Derivatives::kGradient;
  EXPECT_LT(Render(scene, settings).field->rays, 1.105 * alone);
}

TEST(RayTracingTest, RotationIsThatOfTheIrradiance) {
  SceneMaker maker;
  maker.Segment("floor", {0, 0}, {2, 0}, {.reflectance = {0.6}})
      .Segment("wall", {0, 1.5}, {0, 0}, {.reflectance = {0.8}});
  maker.Segment("lamp", {1.6, 1}, {0.8, 1.2}, {.radiance = {2}});
  maker.Light(PointLightDescription{{1, 0.8}, {2}}).Environment({0.3});
  const Point2 place{0.15, 0.3};
  constexpr double kStep = 0.1;
  SceneMaker points = maker;
  for (const double turn : {-2 * kStep, -kStep, kStep, 2 * kStep})
    points.PointProbe(place, {std::sin(turn), std::cos(turn)});
  const auto traced = Render(points.Build(), Sampled(1u << 16)).field;
  const auto value = [&](std::size_t i) { return traced->probes[i].irradiance[0]; };
  double variance = 0;
  for (const ProbeField& probe : traced->probes) variance += probe.standard_error[0] * probe.standard_error[0];
  const double difference = (8 * (value(2) - value(1)) - (value(3) - value(0))) / (12 * kStep);
  const double noise = 8 * std::sqrt(variance / 2) / (12 * kStep);
  EXPECT_GT(std::abs(difference), 0.3);
  const auto scene = maker.PointProbe(place, {0, 1}).Build();
  for (const Formulation formulation : {Formulation::kStratified, Formulation::kPolyline, Formulation::kArcLength}) {
    // Few rays a gather show what is biased by their number.
    HonestErrors errors;
    double mean = 0;
    constexpr int kSeeds = 200;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
      Settings settings = Branching(256, seed);
      settings.formulation = formulation;
      const ProbeField field = Render(scene, settings).field->probes[0];
      errors.Add(field.rotation_gradient[0], difference, field.rotation_gradient_error[0]);
      mean += field.rotation_gradient[0] / kSeeds;
      EXPECT_LT(field.rotation_gradient_error[0], 0.15);
    }
    EXPECT_NEAR(mean, difference, 5 * noise + 0.01) << static_cast<int>(formulation);
    EXPECT_LT(errors.MeanSquareZ(), 1.6) << static_cast<int>(formulation);
  }
}

// Close to a wall whose lowest part, all that is seen along the horizon, is darker than the rest.
TEST(RayTracingTest, RotationIsNotBiasedByFewRays) {
  SceneMaker maker;
  maker.Segment("floor", {0, 0}, {1, 0}, {.reflectance = {0}});
  maker.Segment("wall", {0, 1}, {0, 0}, {.reflectance = {0.9}}).Segment("shelf", {0.4, 0.1}, {0.9, 0.1});
  maker.Segment("lamp", {1, 0}, {1, 1}, {.radiance = {3}}).PointProbe({0.04, 0}, {0, 1});
  const auto scene = maker.Build();
  for (const Formulation formulation : {Formulation::kStratified, Formulation::kPolyline}) {
    Settings settings = Branching(1u << 17);
    settings.formulation = formulation;
    const ProbeField truth = Render(scene, settings).field->probes[0];
    HonestErrors errors;
    for (std::uint32_t seed = 0; seed < 400; ++seed) {
      settings.samples = 256;
      settings.seed = seed;
      const ProbeField field = Render(scene, settings).field->probes[0];
      errors.Add(field.rotation_gradient[0], truth.rotation_gradient[0], field.rotation_gradient_error[0]);
    }
    EXPECT_TRUE(errors.Unbiased()) << errors.MeanZ();
    EXPECT_LT(errors.MeanSquareZ(), 1.6);
  }
}

TEST(RayTracingTest, SameBitsForAnyThreadsSlicesAndSkips) {
  const auto scene = FurnishedRoom(false, 3).Build();
  Settings settings = Branching(256);
  const std::uint64_t one = HashOf(*Render(scene, settings).field);
  EXPECT_EQ(HashOf(*Render(scene, settings, 2).field), one);
  EXPECT_EQ(HashOf(*Render(scene, settings, 7, std::chrono::microseconds(50)).field), one);
  EXPECT_NE(HashOf(*Render(scene, Branching(256, 1)).field), one);
  for (const std::string& name : SkipNames()) {
    settings.no_skip = {name};
    EXPECT_EQ(HashOf(*Render(scene, settings).field), one) << name;
  }
}

TEST(RayTracingTest, StopsAtItsTarget) {
  const auto scene = SquareRoom({.reflectance = {0.6}, .radiance = {1}}, 2).Build();
  Settings settings;
  settings.method = Method::kRayTracing;
  settings.target_error = 0.01;
  const Ended ended = Render(scene, settings);
  EXPECT_EQ(ended.reason, EndReason::kTargetReached);
  for (const ProbeField& probe : ended.field->probes) {
    for (std::size_t i = 0; i < probe.irradiance.size(); ++i) {
      EXPECT_LE(probe.standard_error[i], 0.01 * probe.irradiance[i]);
      EXPECT_NEAR(probe.irradiance[i], 5, 6 * probe.standard_error[i]);
    }
  }
}

// Points stop in different passes. What is told of their errors is what was known when they stopped.
TEST(RayTracingTest, PointsThatStopEarlyKeepTheirErrors) {
  SceneMaker maker = UnitLight();
  maker.Segment("blocker", {0.5, 0.5}, {1.2, 0.5})
      .Segment("white", {-1, 0}, {-1, 1}, {.reflectance = {0.8}})
      .Probe("floor", 100);
  const auto scene = maker.Build();
  Settings settings;
  settings.method = Method::kRayTracing;
  settings.target_error = 0.05;
  settings.derivatives = Derivatives::kNone;
  const Ended ended = Render(scene, settings);
  EXPECT_EQ(ended.reason, EndReason::kTargetReached);
  const ProbeField& floor = ended.field->probes[0];
  EXPECT_NE(*std::min_element(floor.samples.begin(), floor.samples.end()),
            *std::max_element(floor.samples.begin(), floor.samples.end()));
  double mean = 0;
  for (const double value : floor.irradiance) mean += value / 100;
  // The pass that is delivered follows the one that decided, with twice as many rays.
  for (std::size_t i = 0; i < floor.irradiance.size(); ++i)
    EXPECT_LE(floor.standard_error[i], 0.05 * std::max(floor.irradiance[i], 0.01 * mean)) << i;
}

// Gathers are stratified: with four times the rays the error of direct light falls to a quarter or less.
TEST(RayTracingTest, ErrorOfDirectLightFallsAsOneOverRays) {
  SceneMaker maker = UnitLight();
  maker.Segment("blocker", {0.5, 0.5}, {1.2, 0.5}).Probe("floor", 64);
  const auto scene = maker.Build();
  Settings exact;
  exact.method = Method::kExact;
  const std::vector<double> truth = Render(scene, exact).field->probes[0].irradiance;
  std::vector<double> errors;
  for (const std::uint32_t samples : {256u, 4096u}) {
    const std::vector<double> found = Render(scene, Branching(samples)).field->probes[0].irradiance;
    double sum = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) sum += (found[i] - truth[i]) * (found[i] - truth[i]);
    errors.push_back(std::sqrt(sum));
  }
  EXPECT_LT(errors[1], errors[0] / 11) << "16 times the rays";
}

// Of what reflects there is no Hessian; of direct light it is exact here.
TEST(RayTracingTest, HessianOfDirectLightAlone) {
  SceneMaker maker = UnitLight();
  maker.Segment("blocker", {0.5, 0.5}, {1.2, 0.5})
      .Segment("white", {-1, 0}, {-1, 1}, {.reflectance = {0.8}})
      .Probe("floor", 7);
  const auto scene = maker.Build();
  EXPECT_TRUE(Render(scene, Branching(256)).field->probes[0].hessian.empty());
  Settings direct = Branching(256), exact;
  direct.max_bounces = 0;
  exact.max_bounces = 0;
  exact.method = Method::kExact;
  const ProbeField found = Render(scene, direct).field->probes[0], truth = Render(scene, exact).field->probes[0];
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_NEAR(found.gradient[i], truth.gradient[i], 1e-9);
    EXPECT_NEAR(found.hessian[i], truth.hessian[i], 1e-9);
  }
}

TEST(RayTracingTest, Darkness) {
  const auto scene = SquareRoom({.reflectance = {0.6}}, 1).Build();
  const Ended ended = Render(scene, Branching(256));
  EXPECT_EQ(ended.field->rays, 0);
  EXPECT_EQ(ended.field->probes[0].irradiance, std::vector<double>{0});
  EXPECT_EQ(ended.field->probes[0].standard_error, std::vector<double>{0});
  EXPECT_EQ(ended.field->probes[0].gradient, std::vector<double>{0});
  EXPECT_EQ(ended.field->probes[0].gradient_error, std::vector<double>{0});
  EXPECT_EQ(ended.field->probes[0].samples, std::vector<double>{256});
}

}  // namespace
}  // namespace flatlight
