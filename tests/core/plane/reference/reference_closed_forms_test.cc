// SPDX-License-Identifier: Apache-2.0
// Light of all bounces where it is known: every value within the bound that is stated for it, and the bound small.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/transport/scene_maker.h"
#include "tests/support/transport/solve_reference.h"

namespace flatlight {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

ReferenceOptions Options(double target, std::optional<std::uint32_t> max_bounces = {}) {
  ReferenceOptions options;
  options.channels = 1;
  options.max_bounces = max_bounces;
  options.target_error = target;
  return options;
}

// All points have this irradiance, and no derivatives; bounds are below `relative` of it.
void ExpectEverywhere(const SolvedReference& solved, double irradiance, double relative) {
  EXPECT_EQ(solved.state, ReferenceSolver::State::kReached);
  EXPECT_FALSE(solved.values.empty());
  for (const ExactValue& value : solved.values) {
    EXPECT_LE(std::abs(value.irradiance[0] - irradiance), value.irradiance_error[0]);
    EXPECT_LE(value.irradiance_error[0], relative * irradiance);
    EXPECT_LE(std::abs(value.gradient[0]), value.gradient_error[0]);
    EXPECT_LE(std::abs(value.hessian[0]), value.hessian_error[0]);
  }
}

// E = 2 Le / (1 - rho), sharp as rho comes near to 1.
TEST(ReferenceClosedFormsTest, AFurnaceIsLitAlikeEverywhere) {
  for (const double reflectance : {0.5, 0.9, 0.99, 0.9999}) {
    const auto square = SquareRoom({.reflectance = {reflectance}, .radiance = {1}}, 5).Build();
    ExpectEverywhere(SolveReference(square, Options(1e-8)), 2 / (1 - reflectance), 1e-8);
    SceneMaker maker;
    maker.Arc("wall", {{0, 0}, 1, 0, kTurn}, {.reflectance = {reflectance}, .radiance = {1}}).Probe("wall", 7);
    ExpectEverywhere(SolveReference(maker.Build(), Options(1e-8)), 2 / (1 - reflectance), 1e-8);
  }
}

// A point in a corner sees what is seen just beyond it: half and more of that may be the wall behind, at no distance.
TEST(ReferenceClosedFormsTest, AFurnaceIsLitInItsCornersToo) {
  const std::vector<Point2> square = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  const std::vector<Point2> sharp = {{0, 0}, {3, -1}, {2, 0}, {3, 1}};  // Its sides are as long as their opposites.
  for (const std::vector<Point2>& corners : {square, sharp}) {
    SceneMaker maker;
    maker.Polyline("wall", corners, true, {.reflectance = {0.5}, .radiance = {1}}).Probe("wall", 2);
    ReferenceOptions options = Options(1e-8);
    options.derivatives = 0;
    const SolvedReference solved = SolveReference(maker.Build(), options);
    ASSERT_EQ(solved.values.size(), 2u);
    for (const ExactValue& value : solved.values) {
      EXPECT_LE(std::abs(value.irradiance[0] - 4), value.irradiance_error[0]);
      EXPECT_LE(value.irradiance_error[0], 1e-8 * 4);
    }
  }
}

// 2 Le (1 + rho + ... + rho^k).
TEST(ReferenceClosedFormsTest, AFurnaceOfSomeBounces) {
  const auto scene = SquareRoom({.reflectance = {0.8}, .radiance = {1}}, 3).Build();
  double sum = 0, power = 2;
  for (std::uint32_t bounces = 0; bounces < 6; ++bounces, power *= 0.8) {
    sum += power;
    ExpectEverywhere(SolveReference(scene, Options(1e-8, bounces)), sum, 1e-8);
  }
  for (const std::uint32_t all : {200u, 1000000u})
    ExpectEverywhere(SolveReference(scene, Options(1e-8, all)), 10, 1e-8);
}

// What emits as much as it absorbs cannot be told from the sky behind it, whatever stands where.
TEST(ReferenceClosedFormsTest, AFurnaceUnderTheSky) {
  SceneMaker maker;
  const auto look = [](double reflectance) {
    return Look{.reflectance = {reflectance}, .radiance = {3 * (1 - reflectance)}, .two_sided = true};
  };
  maker.Environment({3});
  maker.Segment("floor", {-1, 0}, {1, 0}, look(0.7));
  maker.Segment("wall", {1, 0}, {1.2, 0.8}, look(0.4));
  maker.Segment("plate", {-0.5, 0.4}, {0.2, 0.3}, look(0.9));
  maker.Arc("ball", {{0.5, 0.5}, 0.2, 0, -kTurn}, look(0.6));
  maker.Arc("bowl", {{-0.6, 0.3}, 0.2, 3, 3}, look(0.8));
  for (const char* curve : {"floor", "plate", "ball", "bowl"}) maker.Probe(curve, 6);
  maker.PointProbe({0, 0.9}, {0, -1});
  ExpectEverywhere(SolveReference(maker.Build(), Options(1e-8)), 6, 1e-8);
}

// Two walls that face each other from end to end of a long corridor, in its middle: each sees nothing but the other.
TEST(ReferenceClosedFormsTest, ALongCorridor) {
  const double reflectance = 0.6, half_length = 2000;
  SceneMaker maker;
  maker.Segment("floor", {-half_length, 0}, {half_length, 0}, {.reflectance = {reflectance}, .radiance = {1}});
  maker.Segment("ceiling", {half_length, 1}, {-half_length, 1}, {.reflectance = {reflectance}, .radiance = {1}});
  maker.PointProbe({0.3, 0}, {0, 1});
  const SolvedReference solved = SolveReference(maker.Build(), Options(1e-8));
  EXPECT_EQ(solved.state, ReferenceSolver::State::kReached);
  // The ends are missing: 1 - sin, for each bounce.
  EXPECT_NEAR(solved.values[0].irradiance[0] * (1 - reflectance) / 2, 1, 4e-7);
  EXPECT_LT(solved.values[0].irradiance[0] * (1 - reflectance) / 2, 1 - 1e-8);
}

// A disc that emits inside a round wall: both are lit alike all over.
TEST(ReferenceClosedFormsTest, ADiscInARoundRoom) {
  const double inner = 0.3, wall = 0.8, disc = 0.6;
  SceneMaker maker;
  maker.Arc("wall", {{0, 0}, 1, 0, kTurn}, {.reflectance = {wall}});
  maker.Arc("disc", {{0, 0}, inner, 0, -kTurn}, {.reflectance = {disc}, .radiance = {1}});
  maker.Probe("wall", 9);
  // The wall sees the disc under the share `inner` of its light; the disc sees the wall alone:
  // w = wall (inner d + (1 - inner) w), d = 1 + disc w.
  const double w = wall * inner / (1 - wall * (1 - inner) - wall * inner * disc);
  ExpectEverywhere(SolveReference(maker.Build(), Options(1e-8)), 2 * w / wall, 1e-8);
}

// I/r straight from the light, and that over 1 - rho after all bounces.
TEST(ReferenceClosedFormsTest, APointLightInTheMiddleOfARoundRoom) {
  SceneMaker maker;
  maker.Arc("wall", {{0, 0}, 2, 0, kTurn}, {.reflectance = {0.75}}).Probe("wall", 9);
  maker.Light(PointLightDescription{{0, 0}, {kTurn}});
  ExpectEverywhere(SolveReference(maker.Build(), Options(1e-8)), 0.5 / 0.25, 1e-8);
}

// Half of a round room's wall emits. On a circle light goes from angle to angle by sin(difference / 2) / 4 alone, so it
// is a product for each term of a Fourier series: rho / (1 - 4 k^2).
TEST(ReferenceClosedFormsTest, ARoundRoomHalfOfWhichEmits) {
  const double reflectance = 0.7;
  SceneMaker maker;
  maker.Arc("lamp", {{0, 0}, 1, 0, kTurn / 2}, {.reflectance = {reflectance}, .radiance = {1}});
  maker.Arc("wall", {{0, 0}, 1, kTurn / 2, kTurn / 2}, {.reflectance = {reflectance}});
  maker.Probe("wall", 8).Probe("lamp", 5);
  const SolvedReference solved = SolveReference(maker.Build(), Options(1e-8));
  EXPECT_EQ(solved.state, ReferenceSolver::State::kReached);
  for (std::size_t i = 0; i < solved.values.size(); ++i) {
    const double angle = i < 8 ? kTurn / 2 * (1 + (static_cast<double>(i) + 0.5) / 8)
                               : kTurn / 2 * (static_cast<double>(i - 8) + 0.5) / 5;
    // The emitter is 1/2 + sum of 2/(pi k) sin(k angle), k odd. E = 2 T / (1 - rho T) of it.
    double irradiance = 1 / (1 - reflectance);
    for (int k = 40001; k > 0; k -= 2) {
      const double t = 1 / (1 - 4.0 * k * k);
      irradiance += 2 * t / (1 - reflectance * t) * 4 / (kTurn * k) * std::sin(k * angle);
    }
    EXPECT_NEAR(solved.values[i].irradiance[0], irradiance, solved.values[i].irradiance_error[0] + 1e-11) << i;
    EXPECT_LE(solved.values[i].irradiance_error[0], 1e-8 * irradiance);
  }
}

}  // namespace
}  // namespace flatlight
