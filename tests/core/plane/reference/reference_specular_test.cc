// SPDX-License-Identifier: Apache-2.0
// Light over mirrors and through glass, against scenes without them that have the same light.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "core/scene/material.h"
#include "tests/support/transport/scene_maker.h"
#include "tests/support/transport/solve_reference.h"

namespace flatlight {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

ReferenceOptions Options(double target) {
  ReferenceOptions options;
  options.derivatives = 0;
  options.channels = 1;
  options.target_error = target;
  return options;
}

Look MirrorOf(double reflectance) { return {.material = MirrorDescription{SpectrumValues{reflectance}}}; }
Look Glass(double ior) { return {.material = DielectricDescription{ior}}; }

void ExpectNear(const SolvedReference& left, const SolvedReference& right, double relative) {
  ASSERT_EQ(left.state, ReferenceSolver::State::kReached);
  ASSERT_EQ(right.state, ReferenceSolver::State::kReached);
  ASSERT_LE(left.values.size(), right.values.size());
  for (std::size_t i = 0; i < left.values.size(); ++i) {
    const ExactValue &l = left.values[i], &r = right.values[i];
    EXPECT_LE(std::abs(l.irradiance[0] - r.irradiance[0]), l.irradiance_error[0] + r.irradiance_error[0]) << i;
    EXPECT_LE(l.irradiance_error[0], relative * l.irradiance[0]) << i;
  }
}

// Half a room beside a perfect mirror is a whole room.
TEST(ReferenceSpecularTest, APerfectMirrorCompletesARoom) {
  const Look grey{.reflectance = {0.6}}, lamp{.radiance = {5}, .two_sided = true}, plate{.reflectance = {0.3}};
  SceneMaker half, whole;
  half.Segment("mirror", {0, 1}, {0, -1}, MirrorOf(1));
  half.Polyline("walls", {{0, -1}, {1.5, -1}, {1.5, 1}, {0, 1}}, false, grey);
  half.Segment("lamp", {0.4, 0.5}, {0.7, 0.6}, lamp).Segment("plate", {0.3, -0.3}, {0.9, 0.1}, plate);
  half.Arc("ball", {{1.1, -0.6}, 0.2, 0, -kTurn}, plate);
  whole.Polyline("walls", {{0, -1}, {1.5, -1}, {1.5, 1}, {0, 1}}, false, grey);
  whole.Polyline("other walls", {{0, 1}, {-1.5, 1}, {-1.5, -1}, {0, -1}}, false, grey);
  whole.Segment("lamp", {0.4, 0.5}, {0.7, 0.6}, lamp).Segment("plate", {0.3, -0.3}, {0.9, 0.1}, plate);
  whole.Segment("lamp'", {-0.7, 0.6}, {-0.4, 0.5}, lamp).Segment("plate'", {-0.9, 0.1}, {-0.3, -0.3}, plate);
  whole.Arc("ball", {{1.1, -0.6}, 0.2, 0, -kTurn}, plate).Arc("ball'", {{-1.1, -0.6}, 0.2, 0, -kTurn}, plate);
  for (SceneMaker* maker : {&half, &whole})
    for (const char* curve : {"walls", "plate", "ball"}) maker->Probe(curve, 9);
  for (const double target : {1e-3, 1e-5})
    ExpectNear(SolveReference(half.Build(), Options(target)), SolveReference(whole.Build(), Options(target)), target);
}

// All light comes back to where it emits: E = 2 L, whatever mirrors and glass stand about.
void ExpectFurnace(SceneMaker maker, double reflectance, double target) {
  maker.Polyline("walls", {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, true,
                 {.reflectance = {reflectance}, .radiance = {1 - reflectance}});
  maker.Probe("walls", 8);  // None in a corner.
  const SolvedReference solved = SolveReference(maker.Build(), Options(target));
  EXPECT_EQ(solved.state, ReferenceSolver::State::kReached) << solved.relative_error;
  for (const ExactValue& value : solved.values) {
    EXPECT_LE(std::abs(value.irradiance[0] - 2), value.irradiance_error[0]);
    EXPECT_LE(value.irradiance_error[0], 2 * target);
  }
}

TEST(ReferenceSpecularTest, AFurnaceWithPlaneMirrorsIsLitAlikeEverywhere) {
  for (const double reflectance : {0.5, 0.99}) {
    SceneMaker maker;
    maker.Segment("mirror", {-0.6, 0.5}, {-0.2, 0.8}, MirrorOf(1));
    maker.Segment("other mirror", {0.3, 0.7}, {0.7, 0.5}, MirrorOf(1));
    ExpectFurnace(maker, reflectance, 1e-5);
  }
}

TEST(ReferenceSpecularTest, AFurnaceWithAPrismIsLitAlikeEverywhere) {
  SceneMaker maker;
  maker.Polyline("prism", {{-0.3, -0.6}, {0.4, -0.5}, {0.1, 0.1}}, true, Glass(1.5));
  ExpectFurnace(maker, 0.5, 1e-3);
}

TEST(ReferenceSpecularTest, AFurnaceWithRoundMirrorsIsLitAlikeEverywhere) {
  SceneMaker maker;
  maker.Arc("ball", {{0.4, 0.4}, 0.3, 0, -kTurn}, MirrorOf(1)).Arc("bowl", {{-0.4, 0.1}, 0.3, 1, 2}, MirrorOf(1));
  ExpectFurnace(maker, 0.8, 1e-3);
}

TEST(ReferenceSpecularTest, AFurnaceWithABallOfGlassIsLitAlikeEverywhere) {
  SceneMaker maker;
  maker.Arc("ball", {{-0.4, -0.2}, 0.25, 0, -kTurn}, Glass(1.5));
  ExpectFurnace(maker, 0.5, 1e-2);
}

// Under water of index 1.5, beneath a sky of radiance 1, radiance is 1.5 where the sky is seen (THEORY 17 A6), but for
// what the surface reflects back; what it reflects totally is dark.
TEST(ReferenceSpecularTest, RadianceIsLargerWhereLightIsSlower) {
  SceneMaker maker;
  maker.Environment({1});
  maker.Segment("surface", {1e3, 0}, {-1e3, 0}, Glass(1 / 1.5));
  maker.Segment("bottom", {-1e3, -1}, {1e3, -1});
  maker.PointProbe({0, -1}, {0, 1});
  const SolvedReference solved = SolveReference(maker.Build(), Options(1e-6));
  ASSERT_EQ(solved.state, ReferenceSolver::State::kReached);
  for (const ExactValue& value : solved.values) EXPECT_NEAR(value.irradiance[0], 1.86405, 1e-4);
}

}  // namespace
}  // namespace flatlight
