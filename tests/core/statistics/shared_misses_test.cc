// SPDX-License-Identifier: Apache-2.0
#include "core/statistics/shared_misses.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "core/statistics/replicates.h"

namespace flatlight {
namespace {

constexpr int kPoints = 33;
constexpr double kBright = 10;
using Values = std::array<double, kReplicates>;

Values RareValues(std::mt19937_64& random, double chance) {
  std::uniform_real_distribution<double> uniform;
  Values values;
  for (double& value : values) value = 0.1 * uniform(random) + (uniform(random) < chance ? kBright : 0);
  return values;
}

// One value in 30 is bright: in three points of five none of 16 is, and these are off by 1/30 of it.
TEST(SharedMissesTest, PointsThatMissedBrightValuesKnowOfThemFromOthers) {
  std::mt19937_64 random(1);
  double mean_square = 0;
  constexpr int kTrials = 500;
  for (int i = 0; i < kTrials; ++i) {
    SharedMisses misses;
    for (int p = 0; p < kPoints; ++p) misses.Add(HalvesSpreadOf(RareValues(random, 1 / 30.0)), kBright);
    ASSERT_TRUE(misses.any());
    mean_square += *misses.MeanSquare(kBright / kHalfReplicates) / kTrials;
  }
  const double truth = kBright / 30 * kBright / 30;
  EXPECT_GT(mean_square, truth);
  EXPECT_LT(mean_square, 2 * truth);
}

TEST(SharedMissesTest, WhatNoValueMetIsAsRareAsPointsAreMany) {
  std::mt19937_64 random(2);
  SharedMisses few, many;
  for (int p = 0; p < 3; ++p) few.Add(HalvesSpreadOf(RareValues(random, 0)), kBright);
  for (int p = 0; p < kPoints; ++p) many.Add(HalvesSpreadOf(RareValues(random, 0)), kBright);
  EXPECT_FALSE(many.any());
  EXPECT_NEAR(std::sqrt(*few.MeanSquare(1)), std::sqrt(2) / 3, 1e-12);
  EXPECT_NEAR(std::sqrt(*many.MeanSquare(1)), std::sqrt(2) / kPoints, 1e-12);
}

TEST(SharedMissesTest, PointsTogetherAreThoseOfEither) {
  std::mt19937_64 random(3);
  SharedMisses all, first, second;
  for (int p = 0; p < kPoints; ++p) {
    const Values values = RareValues(random, 0.05);
    all.Add(HalvesSpreadOf(values), kBright);
    (p < 10 ? first : second).Add(HalvesSpreadOf(values), kBright);
  }
  first.Add(second);
  EXPECT_NEAR(*first.MeanSquare(1), *all.MeanSquare(1), 1e-12);
}

TEST(SharedMissesTest, ValuesThatAllMeetEventsTellNothing) {
  std::mt19937_64 random(4);
  SharedMisses misses;
  for (int p = 0; p < kPoints; ++p) misses.Add(HalvesSpreadOf(RareValues(random, 0.5)), 0.01);
  EXPECT_FALSE(misses.MeanSquare(1).has_value());
}

}  // namespace
}  // namespace flatlight
