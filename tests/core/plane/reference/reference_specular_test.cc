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

// A narrow beam through a prism: most of the wall is so dim that what ways could have brought that were not followed
// matters, so these are followed further, until the bound is as small as wanted.
TEST(ReferenceSpecularTest, FollowsWaysAsFarAsTheTargetNeeds) {
  SceneMaker maker;
  maker.Polyline("prism", {{-0.55, -0.35}, {0, 0.6}, {0.55, -0.35}}, true, Glass(1.5));
  maker.Segment("lamp", {-2.2846, -0.4876}, {-2.2463, -0.6013}, {.radiance = {60}});
  maker.Polyline("tube",
                 {{-1.0141, -0.1869}, {-2.2463, -0.6013}, {-2.3602, -0.5764}, {-2.2846, -0.4876}, {-1.0524, -0.0732}},
                 false, {});
  maker.Segment("wall", {1.8, -1}, {1.8, 1}, {.reflectance = {0.8}});
  maker.Probe("wall", 16);
  const auto scene = maker.Build();
  const SolvedReference fine = SolveReference(scene, Options(1e-6));
  EXPECT_EQ(fine.state, ReferenceSolver::State::kReached) << fine.relative_error;
  for (const double target : {1e-1, 1e-2, 1e-3}) {
    const SolvedReference coarse = SolveReference(scene, Options(target));
    EXPECT_EQ(coarse.state, ReferenceSolver::State::kReached) << coarse.relative_error;
    for (std::size_t i = 0; i < fine.values.size(); ++i) {
      const ExactValue &a = coarse.values[i], &b = fine.values[i];
      EXPECT_LE(std::abs(a.irradiance[0] - b.irradiance[0]), a.irradiance_error[0] + b.irradiance_error[0]) << i;
    }
  }
}

// The sum over all images in two plane mirrors, each of which dims the lamp once more.
TEST(ReferenceSpecularTest, ParallelMirrorsShowARowOfLamps) {
  SceneMaker maker;
  maker.Segment("lower", {-50, 0}, {50, 0}, MirrorOf(0.9)).Segment("upper", {50, 1}, {-50, 1}, MirrorOf(0.9));
  maker.Segment("lamp", {-1, 0.6}, {-1, 0.4}, {.radiance = {1}});
  maker.PointProbe({0, 0.5}, {-1, 0});
  const auto scene = maker.Build();
  double expected = 0;
  const auto sine = [](double y) { return y / std::hypot(1, y); };
  for (int k = -200; k <= 200; ++k) expected += std::pow(0.9, std::abs(k)) * (sine(k + 0.1) - sine(k - 0.1));
  const SolvedReference solved = SolveReference(scene, Options(1e-7));
  EXPECT_EQ(solved.state, ReferenceSolver::State::kReached) << solved.relative_error;
  ASSERT_EQ(solved.values.size(), 1u);
  EXPECT_NEAR(solved.values[0].irradiance[0], expected, 1e-9 * expected);
  EXPECT_LE(std::abs(solved.values[0].irradiance[0] - expected), solved.values[0].irradiance_error[0] + 1e-12);
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
