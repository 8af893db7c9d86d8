// SPDX-License-Identifier: Apache-2.0
// Bounds that reference states, against much finer solutions of random scenes, and derivatives against differences.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <numbers>
#include <vector>

#include "core/plane/reference/reference_solver.h"
#include "core/scene/scene.h"
#include "tests/support/transport/random_room.h"
#include "tests/support/transport/scene_maker.h"
#include "tests/support/transport/solve_reference.h"

namespace flatlight {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

struct Counts {
  int values = 0;
  int beyond = 0;                // Their bounds.
  std::vector<double> cautions;  // Bound over error.

  void Add(double value, double bound, double truth, double truth_bound) {
    ++values;
    const double error = std::abs(value - truth);
    if (error > bound + truth_bound) ++beyond;
    if (error > 3 * truth_bound) cautions.push_back(bound / error);
  }
  double MedianCaution() {
    const auto middle = cautions.begin() + static_cast<std::ptrdiff_t>(cautions.size() / 2);
    std::nth_element(cautions.begin(), middle, cautions.end());
    return *middle;
  }
};

ReferenceOptions Options(double target) {
  ReferenceOptions options;
  options.channels = 1;
  options.target_error = target;
  return options;
}

TEST(ReferenceBoundsTest, NoErrorIsLargerThanItsBound) {
  Counts irradiance, gradient, hessian;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const auto scene = RandomRoom(seed);
    const SolvedReference coarse = SolveReference(scene, Options(seed % 3 == 1 ? 1e-1 : 1e-2));
    const SolvedReference fine = SolveReference(scene, Options(1e-5));
    ASSERT_EQ(fine.state, ReferenceSolver::State::kReached) << seed;
    for (std::size_t i = 0; i < fine.values.size(); ++i) {
      const ExactValue &a = coarse.values[i], &b = fine.values[i];
      irradiance.Add(a.irradiance[0], a.irradiance_error[0], b.irradiance[0], b.irradiance_error[0]);
      gradient.Add(a.gradient[0], a.gradient_error[0], b.gradient[0], b.gradient_error[0]);
      hessian.Add(a.hessian[0], a.hessian_error[0], b.hessian[0], b.hessian_error[0]);
    }
  }
  EXPECT_EQ(irradiance.values, 16 * 34);
  EXPECT_EQ(irradiance.beyond, 0);
  EXPECT_EQ(gradient.beyond, 0);
  EXPECT_EQ(hessian.beyond, 0);
  EXPECT_GT(irradiance.cautions.size(), 300u);
  // What residuals are known to give is in the values, so that these are better than the bounds need them to be.
  EXPECT_GT(irradiance.MedianCaution(), 20);
  EXPECT_LT(irradiance.MedianCaution(), 60);
  EXPECT_LT(gradient.MedianCaution(), 100);
  EXPECT_LT(hessian.MedianCaution(), 300);
}

// Small angles, gaps of a millionth, things that touch, tiny lamps, nearly white walls. A point in a gap may get next
// to no light: there the target need not be reached, but the bound holds.
TEST(ReferenceBoundsTest, BoundsHoldInHardRooms) {
  Counts counts;
  for (const std::uint64_t seed : {1, 5, 7, 13, 16, 30, 38, 46, 2055, 4040}) {
    const auto scene = HardRoom(seed);
    ReferenceOptions options = Options(1e-2);
    options.derivatives = 0;
    const SolvedReference coarse = SolveReference(scene, options);
    options.target_error = 1e-5;
    const SolvedReference fine = SolveReference(scene, options);
    for (std::size_t i = 0; i < fine.values.size(); ++i) {
      counts.Add(coarse.values[i].irradiance[0], coarse.values[i].irradiance_error[0], fine.values[i].irradiance[0],
                 fine.values[i].irradiance_error[0]);
    }
  }
  EXPECT_EQ(counts.values, 10 * 40);
  EXPECT_EQ(counts.beyond, 0);
  EXPECT_LT(counts.MedianCaution(), 30);
}

// The inside of a closed box in a lit room: no light, no error, and no say in how the rest is solved.
TEST(ReferenceBoundsTest, DarkPlacesDoNotStopTheRest) {
  SceneMaker maker = SquareRoom({.reflectance = {0.7}}, 4);
  maker.Segment("lamp", {0.4, 0.9}, {-0.4, 0.9}, {.radiance = {1}});
  maker.Polyline("box", {{-0.2, -0.2}, {0.2, -0.2}, {0.2, 0.2}, {-0.2, 0.2}}, true, {.reflectance = {0.7}});
  maker.Probe("box", 8);
  const SolvedReference solved = SolveReference(maker.Build(), Options(1e-6));
  EXPECT_EQ(solved.state, ReferenceSolver::State::kReached);
  for (std::size_t i = 16; i < 24; ++i) {
    EXPECT_EQ(solved.values[i].irradiance[0], 0);
    EXPECT_EQ(solved.values[i].irradiance_error[0], 0);
  }
}

// Where walls reflect nearly all light, errors are many bounces old; the bound follows them.
TEST(ReferenceBoundsTest, BoundsStaySharpWhereWallsReflectNearlyAll) {
  for (const double reflectance : {0.9, 0.99, 0.9999}) {
    SceneMaker maker = SquareRoom({.reflectance = {reflectance}}, 6);
    maker.Segment("lamp", {0.4, 0.9}, {-0.3, 0.85}, {.reflectance = {reflectance}, .radiance = {1}});
    maker.Segment("plate", {-0.5, -0.2}, {0.1, -0.1}, {.reflectance = {reflectance}});
    maker.Arc("ball", {{0.5, -0.3}, 0.2, 0, -kTurn}, {.reflectance = {reflectance}});
    const auto scene = maker.Build();
    ReferenceOptions options = Options(1e-2);
    options.derivatives = 0;
    const SolvedReference coarse = SolveReference(scene, options);
    options.target_error = 1e-6;
    const SolvedReference fine = SolveReference(scene, options);
    Counts counts;
    for (std::size_t i = 0; i < fine.values.size(); ++i) {
      counts.Add(coarse.values[i].irradiance[0], coarse.values[i].irradiance_error[0], fine.values[i].irradiance[0],
                 fine.values[i].irradiance_error[0]);
    }
    EXPECT_EQ(counts.beyond, 0) << reflectance;
    ASSERT_GT(counts.cautions.size(), 12u) << reflectance;
    EXPECT_LT(counts.MedianCaution(), 100) << reflectance;
  }
}

SceneMaker BlockedRoom() {
  SceneMaker maker = SquareRoom({.reflectance = {0.7}}, 1);
  maker.Segment("lamp", {0.4, 0.9}, {-0.4, 0.9}, {.reflectance = {0.5}, .radiance = {1}});
  maker.Segment("plate", {-0.5, -0.2}, {0.1, -0.1}, {.reflectance = {0.6}});
  maker.Arc("ball", {{0.5, -0.3}, 0.2, 0, -kTurn}, {.reflectance = {0.8}});
  return maker;
}

// Between neighbours of many points on a wall and around a ball; but for the few that have a kink between them.
TEST(ReferenceBoundsTest, DerivativesAreThoseOfTheIrradiance) {
  constexpr std::size_t kPoints = 400;
  SceneMaker maker = BlockedRoom();
  const SolvedReference solved =
      SolveReference(maker.Probe("floor", kPoints).Probe("ball", kPoints).Build(), Options(1e-8));
  for (const bool ball : {false, true}) {
    const double h = (ball ? kTurn * 0.2 : 2.0) / kPoints;
    const ExactValue* values = &solved.values[4 + (ball ? kPoints : 0)];
    std::size_t first_right = 0, second_right = 0;
    // Near corners differences tell less.
    constexpr std::size_t kFirst = kPoints / 10, kLast = kPoints - kFirst;
    for (std::size_t i = kFirst; i < kLast; ++i) {
      const double before = values[i - 1].irradiance[0], after = values[i + 1].irradiance[0];
      const double first = (after - before) / (2 * h);
      const double second = (after - 2 * values[i].irradiance[0] + before) / (h * h);
      first_right += std::abs(values[i].gradient[0] - first) <= 1e-3 * (std::abs(first) + 0.2) ? 1 : 0;
      second_right += std::abs(values[i].hessian[0] - second) <= 2e-2 * (std::abs(second) + 0.5) ? 1 : 0;
    }
    EXPECT_GE(first_right, 0.95 * (kLast - kFirst)) << ball;
    EXPECT_GE(second_right, 0.9 * (kLast - kFirst)) << ball;
  }
}

TEST(ReferenceBoundsTest, BitsDoNotDependOnThreads) {
  const auto scene = BlockedRoom().Build();
  const SolvedReference one = SolveReference(scene, Options(1e-5));
  EXPECT_GT(one.rounds, 2);
  for (const int threads : {2, 7}) {
    const SolvedReference other = SolveReference(scene, Options(1e-5), threads);
    EXPECT_EQ(other.rounds, one.rounds);
    ASSERT_EQ(other.values.size(), one.values.size());
    EXPECT_EQ(std::memcmp(other.values.data(), one.values.data(), one.values.size() * sizeof(ExactValue)), 0);
  }
}

// A target below rounding is not reached, and that is said.
TEST(ReferenceBoundsTest, SaysWhereRoundingIsInTheWay) {
  const auto scene = SquareRoom({.reflectance = {0.9999}, .radiance = {1}}, 2).Build();
  const SolvedReference solved = SolveReference(scene, Options(1e-14));
  EXPECT_EQ(solved.state, ReferenceSolver::State::kExhausted);
  EXPECT_GT(solved.relative_error, 1e-14);
  EXPECT_LT(solved.relative_error, 1e-9);
}

}  // namespace
}  // namespace flatlight
