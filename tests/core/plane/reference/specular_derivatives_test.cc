// SPDX-License-Identifier: Apache-2.0
// Gradient and Hessian of light over mirrors and through glass, against differences of neighbours and rooms that a
// mirror completes.
#include <gtest/gtest.h>

#include <algorithm>
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
constexpr int kNeighbours = 4;  // On either side.
constexpr double kStep = 0.0005;

ReferenceOptions Options(double target) {
  ReferenceOptions options;
  options.channels = 1;
  options.target_error = target;
  return options;
}

Look MirrorOf(double reflectance) { return {.material = MirrorDescription{SpectrumValues{reflectance}}}; }
Look Glass(double ior) { return {.material = DielectricDescription{ior}}; }

// A black receiver just long enough for a point and its neighbours, alone: another one would come into sight, or begin
// to hide a lamp, between two of them.
enum class Form { kStraight, kConvex, kHollow };
void AddReceiver(SceneMaker& maker, Form form, Point2 middle, double angle) {
  const double length = (2 * kNeighbours + 1) * kStep, radius = 0.2, sweep = length / radius;
  const Vector2 normal{std::cos(angle), std::sin(angle)}, along{normal.y, -normal.x};
  switch (form) {
    case Form::kStraight:
      maker.Segment("receiver", middle + (-0.5 * length) * along, middle + (0.5 * length) * along);
      break;
    case Form::kConvex:
      maker.Arc("receiver", {middle + (-radius) * normal, radius, angle + 0.5 * sweep, -sweep});
      break;
    case Form::kHollow:
      maker.Arc("receiver", {middle + radius * normal, radius, angle + 0.5 * kTurn - 0.5 * sweep, sweep});
      break;
  }
  maker.Probe("receiver", 2 * kNeighbours + 1);
}

struct Difference {
  double value = 0;
  double error = 0;  // About: what one order less makes of it.
};

// Central differences of eighth order, and of sixth.
template <typename Function>
Difference Differentiate(const Function& f) {
  const double one = f(1) - f(-1), two = f(2) - f(-2), three = f(3) - f(-3), four = f(4) - f(-4);
  const double value = (0.8 * one - 0.2 * two + 4. / 105 * three - four / 280) / kStep;
  return {value, std::abs(value - (0.75 * one - 0.15 * two + three / 60) / kStep)};
}

// `tolerance`: of rounding and quadrature in differences, for light of the order of 1.
void ExpectDerivativesOfNeighbours(const SceneMaker& scene, Point2 middle, double angle, double target,
                                   double tolerance) {
  for (const Form form : {Form::kStraight, Form::kConvex, Form::kHollow}) {
    SceneMaker maker = scene;
    AddReceiver(maker, form, middle, angle);
    const SolvedReference solved = SolveReference(maker.Build(), Options(target));
    ASSERT_EQ(solved.state, ReferenceSolver::State::kReached) << solved.relative_error;
    const ExactValue* const at = &solved.values[kNeighbours];
    const Difference gradient = Differentiate([&](int k) { return at[k].irradiance[0]; });
    const Difference hessian = Differentiate([&](int k) { return at[k].gradient[0]; });
    const int which = static_cast<int>(form);
    EXPECT_NEAR(at->gradient[0], gradient.value, at->gradient_error[0] + 4 * gradient.error + tolerance) << which;
    EXPECT_NEAR(at->hessian[0], hessian.value, at->hessian_error[0] + 4 * hessian.error + tolerance) << which;
    // The differences can tell, and so can the bound of the gradient. That of the Hessian may be wide.
    const double size = std::max(std::abs(gradient.value), at->irradiance[0]);
    EXPECT_LE(4 * gradient.error + at->gradient_error[0], 0.1 * size) << which;
    EXPECT_NEAR(at->hessian[0], hessian.value, 0.1 * std::max(size, std::abs(hessian.value))) << which;
  }
}

// Irradiance is found in another way where derivatives are asked for.
TEST(SpecularDerivativesTest, IrradianceIsThatWithoutDerivatives) {
  SceneMaker maker;
  maker.Segment("mirror", {0, 1}, {0, -1}, MirrorOf(0.9));
  maker.Polyline("walls", {{0, -1}, {1.5, -1}, {1.5, 1}, {0, 1}}, false, {.reflectance = {0.6}});
  maker.Segment("lamp", {0.4, 0.5}, {0.7, 0.6}, {.radiance = {5}, .two_sided = true});
  maker.Probe("walls", 8);
  ReferenceOptions without = Options(0.1), with = Options(0.1);
  without.derivatives = 0, with.derivatives = 1;
  const SolvedReference left = SolveReference(maker.Build(), without), right = SolveReference(maker.Build(), with);
  ASSERT_EQ(left.rounds, right.rounds);
  for (std::size_t i = 0; i < left.values.size(); ++i) {
    const ExactValue &l = left.values[i], &r = right.values[i];
    EXPECT_NEAR(l.irradiance[0], r.irradiance[0], 1e-4 * l.irradiance_error[0]) << i;
    EXPECT_NEAR(l.irradiance_error[0], r.irradiance_error[0], 0.1 * l.irradiance_error[0]) << i;
  }
}

// Half a room beside a perfect mirror is a whole room.
TEST(SpecularDerivativesTest, APerfectMirrorCompletesARoom) {
  const Look grey{.reflectance = {0.6}}, lamp{.radiance = {5}, .two_sided = true}, plate{.reflectance = {0.3}};
  SceneMaker half, whole;
  half.Segment("mirror", {0, 1}, {0, -1}, MirrorOf(1));
  half.Polyline("walls", {{0, -1}, {1.5, -1}, {1.5, 1}, {0, 1}}, false, grey);
  whole.Polyline("walls", {{0, -1}, {1.5, -1}, {1.5, 1}, {0, 1}}, false, grey);
  whole.Polyline("other walls", {{0, 1}, {-1.5, 1}, {-1.5, -1}, {0, -1}}, false, grey);
  whole.Segment("lamp'", {-0.7, 0.6}, {-0.4, 0.5}, lamp).Segment("plate'", {-0.9, 0.1}, {-0.3, -0.3}, plate);
  whole.Arc("ball'", {{-1.1, -0.6}, 0.2, 0, -kTurn}, plate);
  for (SceneMaker* maker : {&half, &whole}) {
    maker->Segment("lamp", {0.4, 0.5}, {0.7, 0.6}, lamp).Segment("plate", {0.3, -0.3}, {0.9, 0.1}, plate);
    maker->Arc("ball", {{1.1, -0.6}, 0.2, 0, -kTurn}, plate);
    for (const char* curve : {"walls", "plate", "ball"}) maker->Probe(curve, 8);
  }
  const SolvedReference left = SolveReference(half.Build(), Options(1e-4));
  const SolvedReference right = SolveReference(whole.Build(), Options(1e-5));
  ASSERT_EQ(left.state, ReferenceSolver::State::kReached);
  ASSERT_EQ(right.state, ReferenceSolver::State::kReached);
  for (std::size_t i = 0; i < left.values.size(); ++i) {
    const ExactValue &l = left.values[i], &r = right.values[i];
    EXPECT_NEAR(l.gradient[0], r.gradient[0], l.gradient_error[0] + r.gradient_error[0]) << i;
    EXPECT_NEAR(l.hessian[0], r.hessian[0], l.hessian_error[0] + r.hessian_error[0]) << i;
    EXPECT_LE(l.gradient_error[0], 0.1 * std::max(std::abs(r.gradient[0]), r.irradiance[0])) << i;
  }
}

TEST(SpecularDerivativesTest, LampsInRoundMirrors) {
  SceneMaker maker;
  maker.Segment("lamp", {-0.6, 0.5}, {-0.9, 0.2}, {.radiance = {3}});
  maker.Arc("ball", {{0.5, 0.4}, 0.3, 0, -kTurn}, MirrorOf(0.9));
  maker.Arc("bowl", {{-0.5, 0.8}, 0.5, 0.5, 1.2}, MirrorOf(0.8));
  maker.Segment("blocker", {0, 0.2}, {0.05, 0.4}).Environment({0.5});
  ExpectDerivativesOfNeighbours(maker, {0.1, -0.4}, 1.7, 1e-5, 1e-3);
}

TEST(SpecularDerivativesTest, ALampBehindAPrism) {
  SceneMaker maker;
  maker.Segment("lamp", {-0.6, 0.9}, {-0.8, 0.5}, {.radiance = {3}}).Environment({0.2});
  maker.Polyline("prism", {{-0.3, 0.1}, {0.3, 0.15}, {0.05, 0.6}}, true, Glass(1.5));
  ExpectDerivativesOfNeighbours(maker, {0.3, -0.4}, 1.8, 1e-5, 1e-3);
}

TEST(SpecularDerivativesTest, ALampBehindABallOfGlass) {
  SceneMaker maker;
  maker.Segment("lamp", {0.3, 1}, {-0.3, 0.9}, {.radiance = {3}});
  maker.Arc("ball", {{0, 0.2}, 0.3, 0, -kTurn}, Glass(1.4));
  ExpectDerivativesOfNeighbours(maker, {0.2, -0.6}, 1.5, 1e-5, 1e-3);
}

// From below water all light comes from within a cone, whose ends move with the receiver where the surface bends.
TEST(SpecularDerivativesTest, UnderABentSurfaceOfWater) {
  SceneMaker maker;
  maker.Arc("surface", {{0, -4}, 5, 2.4, -1.6}, Glass(1 / 1.33));
  maker.Segment("lamp", {1, 2.2}, {-0.5, 2.3}, {.radiance = {3}}).Environment({0.4});
  ExpectDerivativesOfNeighbours(maker, {0.2, 0}, 1.6, 1e-5, 1e-3);
}

// What panels reflect comes over a mirror, with its slopes.
TEST(SpecularDerivativesTest, WallsInARoundMirror) {
  SceneMaker maker;
  maker.Polyline("walls", {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, true, {.reflectance = {0.5}});
  maker.Segment("lamp", {-0.3, 0.95}, {0.3, 0.9}, {.radiance = {5}});
  maker.Arc("bowl", {{0.3, -0.5}, 0.4, 2.5, 2}, MirrorOf(0.9));
  ExpectDerivativesOfNeighbours(maker, {0.4, 0.1}, 4, 3e-4, 1e-2);
}

// Where a mirror's end and a lamp's end are seen in one direction, nothing tells how what is seen moves. Irradiance is
// known all the same.
TEST(SpecularDerivativesTest, IrradianceIsThereWhereDerivativesAreNot) {
  SceneMaker maker;
  maker.Segment("receiver", {-1, 1.05}, {-1, 0.95}).Probe("receiver", 1);
  maker.Segment("mirror", {0, 0}, {2, 0}, MirrorOf(0.9));
  maker.Segment("lamp", {1, 1}, {1, 2}, {.reflectance = {0.5}, .radiance = {1}});
  ReferenceOptions options = Options(1e-4);
  options.derivatives = 0;
  const SolvedReference still = SolveReference(maker.Build(), options);
  options.derivatives = 2;
  const SolvedReference moving = SolveReference(maker.Build(), options);
  const ExactValue &a = still.values[0], &b = moving.values[0];
  EXPECT_GT(a.irradiance[0], 0.1);
  EXPECT_NEAR(a.irradiance[0], b.irradiance[0], a.irradiance_error[0] + b.irradiance_error[0]);
}

}  // namespace
}  // namespace flatlight
