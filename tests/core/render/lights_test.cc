// SPDX-License-Identifier: Apache-2.0
// Direct light of lights without a surface and of the environment.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "tests/support/transport/render.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;

ProbeField Exact(const SceneMaker& maker) {
  Settings settings;
  settings.method = Method::kExact;
  settings.max_bounces = 0;
  return Render(maker.Build(), settings).field->probes[0];
}

// Derivatives along a probe are those of what the probe shows: central differences over a fine probe, of fourth order.
// Where a second derivative jumps, differences across are of no use: 4 points a kink.
void ExpectDerivatives(const SceneMaker& maker, double length, std::size_t count, double gradient_tolerance,
                       double hessian_tolerance, int kinks = 0) {
  const ProbeField field = Exact(maker);
  const double h = length / static_cast<double>(count);
  double largest = 0;
  for (const double e : field.irradiance) largest = std::max(largest, e);
  ASSERT_GT(largest, 0);
  int left = 4 * kinks;
  for (std::size_t i = 2; i + 2 < count; ++i) {
    const double* e = &field.irradiance[i];
    const double first = (8 * (e[1] - e[-1]) - (e[2] - e[-2])) / (12 * h);
    const double second = (16 * (e[1] + e[-1]) - (e[2] + e[-2]) - 30 * e[0]) / (12 * h * h);
    if (std::abs(field.gradient[i] - first) > gradient_tolerance * largest ||
        std::abs(field.hessian[i] - second) > hessian_tolerance * largest) {
      EXPECT_GE(--left, 0) << i << ": " << field.gradient[i] << ' ' << first << ", " << field.hessian[i] << ' '
                           << second;
    }
  }
}

TEST(LightSolverTest, PointLightOnStraightAndCurvedReceivers) {
  SceneMaker straight;
  straight.Segment("floor", {-2, 0}, {2, 0}).Probe("floor", 400);
  straight.Light(PointLightDescription{{0.3, 1}, {4}});
  ExpectDerivatives(straight, 4, 400, 1e-6, 1e-5);
  SceneMaker hollow;
  hollow.Arc("bowl", {{0, 0}, 1, 3.3, 2.5}).Probe("bowl", 400);
  hollow.Light(PointLightDescription{{0.3, 0.2}, {4}});
  ExpectDerivatives(hollow, 2.5, 400, 1e-6, 1e-5);
  SceneMaker hill;
  hill.Arc("hill", {{0, 0}, 1, 2.2, -1.2}).Probe("hill", 400);
  hill.Light(PointLightDescription{{0.3, 2}, {4}});
  ExpectDerivatives(hill, 1.2, 400, 1e-6, 1e-5);
}

TEST(LightSolverTest, ClosedFormBelowAPointLight) {
  SceneMaker maker;
  maker.PointProbe({0, 0}, {0, 1});
  maker.Light(PointLightDescription{{0.6, 0.8}, {kFullTurn}});
  const ProbeField field = Exact(maker);
  const double c = 0.8, s = 0.6;
  EXPECT_NEAR(field.irradiance[0], c, 1e-14);
  EXPECT_NEAR(field.gradient[0], 2 * c * s, 1e-14);
  EXPECT_NEAR(field.hessian[0], 2 * c * (4 * s * s - 1), 1e-14);
  EXPECT_LT(field.hessian_error[0], 1e-12);
}

TEST(LightSolverTest, SpotFadesSmoothly) {
  for (const double side : {-1.0, 1.0}) {
    SceneMaker maker;
    maker.Arc("hill", {{0, -3}, 3, 2.2, -1.2}).Probe("hill", 2000);
    maker.Light(SpotLightDescription{{0.1, 1}, {0.3 * side, -1}, {4}, 0.2, 0.9});
    ExpectDerivatives(maker, 3.6, 2000, 1e-5, 1e-3, 4);
  }
}

TEST(LightSolverTest, DirectionalLightOnAHill) {
  SceneMaker maker;
  maker.Arc("hill", {{0, 0}, 1, 2.2, -1.2}).Probe("hill", 400);
  maker.Light(DirectionalLightDescription{{0.2, -1}, {4}});
  ExpectDerivatives(maker, 1.2, 400, 1e-6, 1e-5);
}

TEST(LightSolverTest, NothingComesThroughWalls) {
  SceneMaker maker;
  maker.Segment("roof", {-1, 1}, {1, 1});
  maker.PointProbe({0, 0}, {0, 1});
  maker.Light(PointLightDescription{{0, 2}, {4}}).Light(DirectionalLightDescription{{0, -1}, {4}});
  EXPECT_EQ(Exact(maker).irradiance[0], 0);
}

TEST(EnvironmentTest, OpenPlaneAndRoof) {
  SceneMaker open;
  open.PointProbe({0, 0}, {0, 1}).Environment({3});
  EXPECT_NEAR(Exact(open).irradiance[0], 6, 1e-14);
  EXPECT_EQ(Exact(open).gradient[0], 0);
  SceneMaker roof;
  roof.Segment("roof", {1, 1}, {-0.5, 1}, {.radiance = {1}}).PointProbe({0, 0}, {0, 1}).Environment({3});
  const double a = 1 / std::hypot(1, 1), b = 0.5 / std::hypot(0.5, 1);
  const ProbeField field = Exact(roof);
  EXPECT_NEAR(field.irradiance[0], 6 - 2 * (a + b), 1e-14);
}

TEST(EnvironmentTest, DerivativesAmongBlockers) {
  SceneMaker maker;
  maker.Arc("hill", {{0, -3}, 3, 2.2, -1.2}).Probe("hill", 3000);
  maker.Environment({2});
  maker.Arc("ball", {{0.6, 1}, 0.3, 0, -kFullTurn}, {.radiance = {1}});
  ExpectDerivatives(maker, 3.6, 3000, 1e-5, 1e-3, 4);
}

// Sees the same as path tracing: lamps, blockers, a sky and lights at once, in colour.
TEST(EnvironmentTest, AgreesWithPathTracing) {
  SceneMaker maker = FurnishedRoom(false, 16);
  maker.Environment({0.5, 0.6, 0.9});
  maker.Light(PointLightDescription{{1.2, 0.3}, {1, 2, 3}});
  maker.Light(SpotLightDescription{{3.5, 2.5}, {-1, -1}, {2, 1, 3}, 0.1, 0.7});
  maker.Light(DirectionalLightDescription{{1, -2}, {5, 5, 5}});
  SceneDescription description = maker.description();
  description.name = "open room";
  std::erase_if(description.curves, [](const CurveDescription& c) { return c.name == "ceiling" || c.name == "right"; });
  std::erase_if(description.probes, [](const ProbeDescription& p) { return p.curve == "right"; });
  Diagnostics diagnostics;
  const auto scene = BuildScene(description, diagnostics);
  ASSERT_NE(scene, nullptr);
  Settings settings;
  settings.method = Method::kExact;
  settings.max_bounces = 0;
  const Ended exact = Render(scene, settings);
  Settings sampled = Sampled(4096);
  sampled.max_bounces = 0;
  const Ended traced = Render(scene, sampled);
  double sum = 0;
  int count = 0;
  for (std::size_t p = 0; p < exact.field->probes.size(); ++p) {
    for (std::size_t i = 0; i < exact.field->probes[p].irradiance.size(); ++i) {
      const double error = traced.field->probes[p].standard_error[i];
      const double z = (traced.field->probes[p].irradiance[i] - exact.field->probes[p].irradiance[i]) / error;
      EXPECT_LT(std::abs(z), 6) << p << ' ' << i;
      sum += z * z;
      ++count;
    }
  }
  EXPECT_EQ(count, 144);
  EXPECT_LT(sum / count, 1.6);
}

}  // namespace
}  // namespace flatlight
