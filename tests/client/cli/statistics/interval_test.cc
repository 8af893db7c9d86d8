// SPDX-License-Identifier: Apache-2.0
#include "client/cli/statistics/interval.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace flatlight {
namespace {

std::vector<double> Normal(std::mt19937_64& random, int count, double mean, double deviation) {
  std::normal_distribution<double> normal(mean, deviation);
  std::vector<double> values(static_cast<std::size_t>(count));
  for (double& value : values) value = normal(random);
  return values;
}

// B. L. Welch's degrees of freedom, from their definition.
TEST(Interval, DifferenceHasWelchsDegrees) {
  const Estimate a{1, 0.3, 4}, b{3, 0.4, 9};
  const Estimate difference = Difference(a, b);
  EXPECT_DOUBLE_EQ(difference.value, 2);
  EXPECT_DOUBLE_EQ(difference.deviation, 0.5);
  EXPECT_NEAR(difference.degrees, 0.0625 / (0.0081 / 4 + 0.0256 / 9), 1e-9);
  EXPECT_EQ(Difference(a, {3, 0, 0}).degrees, 0);
  EXPECT_TRUE(std::isinf(HalfWidth(Difference(a, {3, 0, 0}), 0.05)));
  EXPECT_EQ(HalfWidth({1, 0, 3}, 0.05), 0);
}

// 20 000 intervals that miss with probability 0.05: 1000 are expected to, with a deviation of 31. Welch's degrees are
// an approximation, good to a part in 20 for samples of 6 and more; 5 deviations for chance fail once in a million
// times.
TEST(Interval, MissesAsOftenAsItSays) {
  std::mt19937_64 random(1);
  int missed = 0;
  constexpr int kTrials = 20'000;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Estimate a = MeanOf(MomentsOf(Normal(random, 6, 1, 1))), b = MeanOf(MomentsOf(Normal(random, 12, 3, 0.5)));
    const Estimate difference = Difference(a, b);
    if (std::abs(difference.value - 2) > HalfWidth(difference, 0.05)) ++missed;
  }
  EXPECT_NEAR(missed, 0.05 * kTrials, 0.05 * 0.05 * kTrials + 5 * 31);
}

}  // namespace
}  // namespace flatlight
