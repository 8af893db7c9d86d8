// SPDX-License-Identifier: Apache-2.0
#include "client/cli/statistics/power_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace flatlight {
namespace {

TEST(PowerFit, FindsALawWithoutNoise) {
  std::vector<LogPoint> points;
  for (const double x : {0.001, 0.01, 0.3, 5.0}) points.push_back({std::log(x), std::log(2 * std::pow(x, -0.75)), x});
  const auto fit = FitPower(points);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->slope.value, -0.75, 1e-12);
  EXPECT_NEAR(fit->slope.deviation, 0, 1e-12);
  EXPECT_EQ(fit->slope.degrees, 2);
  EXPECT_NEAR(std::exp(fit->At(0).value), 2, 1e-12);
  EXPECT_NEAR(std::exp(fit->Reaches(std::log(4)).value), std::pow(2, -1 / 0.75), 1e-12);
}

// x = 0, 1, 2 and y = 0, 1, 0 by hand: slope 0, level 1/3, squares of the residuals 2/3 with 1 degree of freedom.
TEST(PowerFit, DeviationsByHand) {
  const auto fit = FitPower({{0, 0, 0}, {1, 1, 0}, {2, 0, 0}});
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->slope.value, 0, 1e-15);
  EXPECT_NEAR(fit->slope.deviation, std::sqrt(1.0 / 3), 1e-15);
  EXPECT_NEAR(fit->level_deviation, std::sqrt(2.0 / 9), 1e-15);
  EXPECT_NEAR(fit->At(3).value, 1.0 / 3, 1e-15);
  EXPECT_NEAR(fit->At(3).deviation, std::sqrt(2.0 / 9 + 4.0 / 3), 1e-15);
}

TEST(PowerFit, WeighsBySureness) {
  // The third point is 1e4 times less sure: the line goes through the others.
  const auto fit = FitPower({{0, 0, 1e-4}, {1, -1, 1e-4}, {2, 10, 1}, {3, -3, 1e-4}});
  EXPECT_NEAR(fit->slope.value, -1, 0.01);
  // Without the variance of one all weigh alike.
  EXPECT_GT(FitPower({{0, 0, 1e-4}, {1, -1, 1e-4}, {2, 10, 0}, {3, -3, 1e-4}})->slope.value, -0.5);
}

TEST(PowerFit, NeedsThreePointsApart) {
  EXPECT_FALSE(FitPower({}));
  EXPECT_FALSE(FitPower({{0, 0, 0}, {1, 1, 0}}));
  EXPECT_FALSE(FitPower({{1, 0, 0}, {1, 1, 0}, {1, 2, 0}}));
}

// Of 20 000 intervals of 95 % the number that miss the true slope (and the true level elsewhere) is 1000 with a
// deviation of 31; 5 of these fail once in a million times.
TEST(PowerFit, IntervalsMissAsOftenAsTheySay) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  constexpr int kTrials = 20'000;
  int slopes = 0, levels = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<LogPoint> points;
    for (int i = 0; i < 6; ++i) {
      const double deviation = 0.02 * (1 + i % 3);
      points.push_back({1.4 * i, -0.5 * 1.4 * i + deviation * normal(random), deviation * deviation});
    }
    const auto fit = FitPower(points);
    if (std::abs(fit->slope.value + 0.5) > HalfWidth(fit->slope, 0.05)) ++slopes;
    const Estimate level = fit->At(12);
    if (std::abs(level.value + 6) > HalfWidth(level, 0.05)) ++levels;
  }
  EXPECT_NEAR(slopes, 0.05 * kTrials, 5 * 31);
  EXPECT_NEAR(levels, 0.05 * kTrials, 5 * 31);
}

}  // namespace
}  // namespace flatlight
