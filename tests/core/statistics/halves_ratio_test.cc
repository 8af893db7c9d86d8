// SPDX-License-Identifier: Apache-2.0
#include "core/statistics/halves_ratio.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "core/statistics/replicates.h"

namespace flatlight {
namespace {

using Values = std::array<double, kReplicates>;

// Values that share nothing: half of the difference of halves' means has the variance that the mean has.
TEST(HalvesRatiosTest, ValuesThatShareNothingGiveTheVarianceOfTheirMean) {
  std::mt19937_64 random(7);
  std::exponential_distribution<double> exponential;
  double sum = 0;
  constexpr int kPoints = 100'000;
  for (int p = 0; p < kPoints; ++p) {
    Values values;
    for (double& value : values) value = exponential(random);
    sum += HalvesRatios::SquaredError(values) * kReplicates;
  }
  EXPECT_NEAR(sum / kPoints, 1, 5 * std::sqrt(2.4 / kPoints));  // The kurtosis of such a mean is 3 + 6/16.
}

TEST(HalvesRatiosTest, FewPointsAreDrawnTowardsOne) {
  HalvesRatios one, many;
  one.Add(0, 1);
  for (int i = 0; i < 65; ++i) many.Add(0.125, 1);
  EXPECT_EQ(HalvesRatios().Result().ratio, 1);
  EXPECT_GT(one.Result().ratio, 0.85);
  EXPECT_LT(many.Result().ratio, 0.14);
  EXPECT_GT(many.Result().ratio, 0.125);
  EXPECT_EQ(many.Result().Of({1, 2, 15}).variance, 2 * many.Result().ratio);
  const double firm = 65 + 64.0 / 73;
  EXPECT_NEAR(many.Result().Of({1, 1, 15}).degrees_of_freedom, 1 / (1 / 15.0 + 65 / (firm * firm)), 1e-12);
}

}  // namespace
}  // namespace flatlight
