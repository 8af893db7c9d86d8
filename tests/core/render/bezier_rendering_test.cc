// SPDX-License-Identifier: Apache-2.0
// Bézier curves in every method.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/render/plan.h"
#include "tests/support/transport/render.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

// A closed room of four Béziers that bulge in and out, all fronts inside.
SceneMaker Room(const Look& look, std::uint32_t count) {
  SceneMaker maker;
  maker.Bezier("south", {{-1, -1}, {-0.4, -0.6}, {0.2, -1.5}, {1, -1}}, look)
      .Bezier("east", {{1, -1}, {1.4, -0.3}, {1.2, 0.5}, {1, 1}}, look)
      .Bezier("north", {{1, 1}, {0.3, 0.7}, {-0.3, 0.8}, {-1, 1}}, look)
      .Bezier("west", {{-1, 1}, {-1.5, 0.2}, {-0.7, -0.2}, {-1, -1}}, look);
  for (const char* wall : {"south", "east", "north", "west"}) maker.Probe(wall, count);
  return maker;
}

// A floor, and an arch above it that closes it in.
SceneMaker Vault(const Look& look) {
  SceneMaker maker;
  maker.Segment("floor", {-1, 0}, {1, 0}, look)
      .Bezier("arch", {{1, 0}, {0.8, 1.3}, {-0.4, 0.9}, {-1, 0}}, look)
      .Probe("floor", 11)
      .Probe("arch", 11);
  return maker;
}

Settings With(Method method) {
  Settings settings;
  settings.method = method;
  return settings;
}

TEST(BezierRenderingTest, AFurnaceIsLitAlikeEverywhereByExactLight) {
  const Ended ended = Render(Room({.radiance = {3}}, 41).Build(), With(Method::kExact));
  for (const ProbeField& probe : ended.field->probes) {
    for (std::size_t i = 0; i < probe.irradiance.size(); ++i) {
      EXPECT_NEAR(probe.irradiance[i], 6, 1e-13);
      EXPECT_NEAR(probe.gradient[i], 0, 1e-12);
      EXPECT_NEAR(probe.hessian[i], 0, 1e-11);
    }
  }
}

TEST(BezierRenderingTest, AFurnaceIsLitAlikeEverywhereByTheReference) {
  Settings settings = With(Method::kReference);
  settings.target_error = 1e-4;
  const Ended ended = Render(Vault({.reflectance = {0.5}, .radiance = {1}}).Build(), settings);
  for (const ProbeField& probe : ended.field->probes) {
    for (std::size_t i = 0; i < probe.irradiance.size(); ++i) {
      EXPECT_NEAR(probe.irradiance[i], 4, probe.irradiance_error[i]);
      EXPECT_LE(probe.irradiance_error[i], 4e-4);
    }
  }
}

TEST(BezierRenderingTest, AFurnaceIsLitAlikeEverywhereByPathsAndRays) {
  for (const Method method : {Method::kPathTracing, Method::kRayTracing}) {
    Settings settings = With(method);
    settings.samples = method == Method::kPathTracing ? 4096 : 64;
    settings.seed = 3;
    const Ended ended = Render(Room({.reflectance = {0.5}, .radiance = {1}}, 7).Build(), settings);
    for (const ProbeField& probe : ended.field->probes)
      for (std::size_t i = 0; i < probe.irradiance.size(); ++i)
        // 28 values, Student's t with 15 degrees of freedom: beyond 6.5 once in 1e5.
        EXPECT_NEAR(probe.irradiance[i], 4, 6.5 * probe.standard_error[i] + 1e-9);
  }
}

// Seen from a place that is known to the distance at which arcs follow the curve, a lamp low above its horizon gives
// less light than that makes uncertain, which path tracing, that adds it up without noise, states all the same.
TEST(BezierRenderingTest, PathsStateWhatArcsLeaveUncertainOfALampLowAboveTheHorizon) {
  SceneMaker maker;
  maker
      .Bezier("wall", {{-1.5324984456922257, 0.18516035582293405},
                       {-1.1616900242691883, -0.12719776363819285},
                       {-1.304043085482185, -0.2568884346135045},
                       {-0.2545098857630598, -0.5336000128261069}})
      .Segment("lamp", {-0.46, 0.58}, {-0.4, 2}, {.radiance = {1}, .two_sided = true})
      .Probe("wall", 3);
  const auto scene = maker.Build();
  const Ended exact = Render(scene, With(Method::kExact)), paths = Render(scene, Sampled(128, 1));
  const ProbeField &truth = exact.field->probes[0], &sampled = paths.field->probes[0];
  int grazing = 0;
  for (std::size_t i = 0; i < truth.irradiance.size(); ++i) {
    EXPECT_NEAR(sampled.irradiance[i], truth.irradiance[i], 6 * sampled.standard_error[i] + 1e-13) << i;
    EXPECT_LT(sampled.standard_error[i], 1e-8);
    grazing += std::abs(sampled.irradiance[i] - truth.irradiance[i]) > 1e-7 * truth.irradiance[i] ? 1 : 0;
  }
  EXPECT_GT(grazing, 0);
}

// A lamp, a wave that reflects, and a leaf that blocks.
std::shared_ptr<const Scene> Wave() {
  SceneMaker maker;
  maker.Bezier("wave", {{-1, -0.1}, {-0.2, 0.45}, {0.1, -0.6}, {1, 0.05}}, {.reflectance = {0.6}})
      .Bezier("lamp", {{0.6, 1.2}, {0.3, 1.5}, {-0.3, 1.4}, {-0.7, 1.25}}, {.radiance = {3}})
      .Bezier("leaf", {{0.4, 0.5}, {0.1, 0.8}, {-0.15, 0.65}, {-0.3, 0.45}}, {.reflectance = {0.3}})
      .Probe("wave", 16)
      .Probe("leaf", 16, Side::kBack)
      .Probe("leaf", 16);
  return maker.Build();
}

// A lamp in a vault, before a leaf.
std::shared_ptr<const Scene> LitVault() {
  SceneMaker maker = Vault({.reflectance = {0.6}});
  maker.Segment("lamp", {0.5, 0.5}, {0.3, 0.55}, {.radiance = {3}})
      .Bezier("leaf", {{0.2, 0.2}, {0.1, 0.3}, {-0.05, 0.3}, {-0.1, 0.2}});
  return maker.Build();
}

TEST(BezierRenderingTest, PathsAgreeWithTheReference) {
  Settings settings = With(Method::kReference);
  settings.target_error = 1e-3;
  const Ended truth = Render(LitVault(), settings), paths = Render(LitVault(), Sampled(16384, 5));
  for (std::size_t p = 0; p < 2; ++p) {
    const ProbeField &t = truth.field->probes[p], &s = paths.field->probes[p];
    for (std::size_t i = 0; i < t.irradiance.size(); ++i) {
      // 22 values: beyond 7 once in 1e4.
      EXPECT_NEAR(s.irradiance[i], t.irradiance[i], 7 * s.standard_error[i] + t.irradiance_error[i]) << p << " " << i;
      EXPECT_LE(t.irradiance_error[i], 2e-3 * t.irradiance[i]);
    }
  }
}

TEST(BezierRenderingTest, RaysFindDerivativesOfDirectLight) {
  Settings exact = With(Method::kExact);
  exact.max_bounces = 0;
  Settings rays = With(Method::kRayTracing);
  rays.max_bounces = 0;
  rays.samples = 4096;
  rays.seed = 11;
  const Ended truth = Render(Wave(), exact), found = Render(Wave(), rays);
  for (std::size_t p = 0; p < 3; ++p) {
    const ProbeField &t = truth.field->probes[p], &s = found.field->probes[p];
    for (std::size_t i = 0; i < t.irradiance.size(); ++i) {
      EXPECT_NEAR(s.irradiance[i], t.irradiance[i], 7 * s.standard_error[i] + 1e-9) << p << " " << i;
      EXPECT_NEAR(s.gradient[i], t.gradient[i], 0.02 * (1 + std::abs(t.gradient[i]))) << p << " " << i;
    }
  }
}

TEST(BezierRenderingTest, ThreadsDoNotChangeABit) {
  for (const Method method : {Method::kExact, Method::kPathTracing, Method::kRayTracing, Method::kReference}) {
    Settings settings = With(method);
    if (method == Method::kExact) settings.max_bounces = 0;
    if (method == Method::kPathTracing) settings.samples = 64;
    if (method == Method::kRayTracing) settings.samples = 16;
    if (method == Method::kReference) settings.target_error = 1e-2;
    const auto scene = method == Method::kReference ? LitVault() : Wave();
    EXPECT_EQ(HashOf(*Render(scene, settings, 1).field), HashOf(*Render(scene, settings, 3).field));
  }
}

TEST(BezierRenderingTest, TheReferenceSaysThatItHasNoDerivatives) {
  Settings settings = With(Method::kReference);
  settings.derivatives = Derivatives::kGradient;
  Diagnostics diagnostics;
  EXPECT_FALSE(MakePlan(*Wave(), settings, diagnostics).has_value());
  ASSERT_EQ(diagnostics.count(), 1U);
  EXPECT_EQ(diagnostics.kept()[0].path, "settings.derivatives");
}

}  // namespace
}  // namespace flatlight
