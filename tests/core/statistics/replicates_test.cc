// SPDX-License-Identifier: Apache-2.0
#include "core/statistics/replicates.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "tests/support/transport/honest_errors.h"

namespace flatlight {
namespace {

using Values = std::array<double, kReplicates>;

Values NormalValues(std::mt19937_64& random) {
  std::normal_distribution<double> normal(3, 2);
  Values values;
  for (double& value : values) value = normal(random);
  return values;
}

std::span<const double> Half(const Values& values, std::size_t half) {
  return std::span(values).subspan(half * kHalfReplicates, kHalfReplicates);
}

TEST(EstimateMeanTest, KnowsMeanAndVariance) {
  const MeanEstimate estimate = EstimateMean(std::array{1.0, 2.0, 3.0, 6.0}, 0);
  EXPECT_DOUBLE_EQ(estimate.mean, 3);
  EXPECT_DOUBLE_EQ(estimate.variance, (4 + 1 + 0 + 9) / 3.0 / 4);
  EXPECT_EQ(estimate.degrees_of_freedom, 3);
}

// 20000 estimates each; bounds as stated in HonestErrors.
TEST(EstimateMeanTest, StandardErrorHasTheRightSize) {
  std::mt19937_64 random(1);
  HonestErrors errors;
  HonestErrors without_t;
  for (int i = 0; i < 20'000; ++i) {
    const MeanEstimate estimate = EstimateMean(NormalValues(random), 0);
    errors.Add(estimate.mean, 3, estimate.StandardError());
    without_t.Add(estimate.mean, 3, std::sqrt(estimate.variance));
  }
  EXPECT_TRUE(errors.Unbiased()) << errors.MeanZ();
  EXPECT_TRUE(errors.RightSize()) << errors.MeanSquareZ();
  EXPECT_FALSE(without_t.RightSize()) << without_t.MeanSquareZ();
}

// The average of halves has a heavier tail than t_15 (14 degrees of freedom, estimated): its z^2 has a variance near
// 2 + 6/10, which widens the bound by 1 %; there is room for that.
TEST(AverageTest, StandardErrorHasTheRightSize) {
  std::mt19937_64 random(2);
  HonestErrors errors;
  for (int i = 0; i < 4'000; ++i) {
    const Values values = NormalValues(random);
    const MeanEstimate average = Average(EstimateMean(Half(values, 0), 0), EstimateMean(Half(values, 1), 0));
    errors.Add(average.mean, 3, average.StandardError());
  }
  EXPECT_TRUE(errors.Unbiased()) << errors.MeanZ();
  EXPECT_TRUE(errors.RightSize()) << errors.MeanSquareZ();
}

// An edge that stratification hides: each value is the height of a step times (k or k + 1 samples of 64), the latter
// with the fraction's probability. Over all places of the edge the stated error must not be too small, and not idle.
TEST(EstimateMeanTest, AgreeingValuesKeepTheErrorOfOneStep) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform;
  HonestErrors errors;
  HonestErrors without_step;
  for (int i = 0; i < 20'000; ++i) {
    const double fraction = uniform(random);
    Values values;
    for (double& value : values) value = (20 + (uniform(random) < fraction ? 1 : 0)) / 64.0;
    const MeanEstimate estimate = EstimateMean(values, 1 / 64.0);
    errors.Add(estimate.mean, (20 + fraction) / 64, estimate.StandardError());
    without_step.Add(estimate.mean, (20 + fraction) / 64, EstimateMean(values, 0).StandardError());
  }
  EXPECT_LT(errors.MeanSquareZ(), 1);
  EXPECT_GT(errors.MeanSquareZ(), 0.6);
  EXPECT_GT(without_step.MeanSquareZ(), 1e20);
}

TEST(EstimateMeanTest, EqualValuesHaveTheErrorOfRounding) {
  Values values;
  values.fill(2);
  const double error = EstimateMean(values, 0).StandardError();
  EXPECT_GT(error, 0);
  EXPECT_LT(error, 1e-14);
  values.fill(0);
  EXPECT_EQ(EstimateMean(values, 0).StandardError(), 0);
}

// One path of 20 is 20 times as bright. Of 16 values each, the variance of 33 points together is right where each
// point's own is far too small whenever nothing bright was met.
TEST(NearbyVariancesTest, PointsThatAreAlikeShareTheirVariance) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> uniform;
  constexpr int kPoints = 33;
  HonestErrors alone, together;
  double share = 0;
  for (int i = 0; i < 400; ++i) {
    std::array<Values, kPoints> points;
    NearbyVariances variances;
    for (Values& values : points) {
      for (double& value : values) value = uniform(random) + (uniform(random) < 0.05 ? 20 : 0);
      variances.Add(EstimateMean(Half(values, 0), 0).variance * kHalfReplicates,
                    EstimateMean(Half(values, 1), 0).variance * kHalfReplicates);
    }
    const NearbyVariance nearby = variances.Result();
    share += nearby.share / 400;
    for (const Values& values : points) {
      constexpr Missable kSomething{1e-9, 1e-9};
      const MeanEstimate own = EstimateMean(values, kSomething), pooled = EstimateMean(values, kSomething, nearby);
      alone.Add(own.mean, 1.5, own.StandardError());
      together.Add(pooled.mean, 1.5, pooled.StandardError());
    }
  }
  EXPECT_LT(share, 0.2);
  EXPECT_GT(alone.MeanSquareZ(), 3);
  // 13,200 values, whose squares have a variance of kurtosis - 1 = 2.9 or so: 5 standard deviations are 0.08; and 0.05
  // for variances that 33 points tell.
  EXPECT_NEAR(together.MeanSquareZ(), 1, 0.13);
}

// Every eighth point has ten times the spread: it keeps it, and the others theirs.
TEST(NearbyVariancesTest, PointsThatDifferKeepTheirOwn) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  constexpr int kPoints = 32;
  HonestErrors wide, narrow;
  for (int i = 0; i < 400; ++i) {
    std::array<Values, kPoints> points;
    NearbyVariances variances;
    for (int p = 0; p < kPoints; ++p) {
      Values& values = points[static_cast<std::size_t>(p)];
      for (double& value : values) value = (p % 8 == 0 ? 10 : 1) * normal(random);
      variances.Add(EstimateMean(Half(values, 0), 0).variance * kHalfReplicates,
                    EstimateMean(Half(values, 1), 0).variance * kHalfReplicates);
    }
    for (int p = 0; p < kPoints; ++p) {
      const MeanEstimate estimate =
          EstimateMean(points[static_cast<std::size_t>(p)], Missable{1e-9, 1e-9}, variances.Result());
      (p % 8 == 0 ? wide : narrow).Add(estimate.mean, 0, estimate.StandardError());
    }
  }
  EXPECT_LT(wide.MeanSquareZ(), 1.3);
  EXPECT_GT(wide.MeanSquareZ(), 0.8);
  EXPECT_LT(narrow.MeanSquareZ(), 1.1);
}

TEST(NearbyVariancesTest, FewPointsTellNothing) {
  NearbyVariances variances;
  for (int i = 0; i < 3; ++i) variances.Add(1, 2);
  EXPECT_EQ(variances.Result().share, 1);
}

TEST(RelativeErrorTest, DarkPointsAreMeasuredByTheFloor) {
  EXPECT_EQ(RelativeError(2, 0.5, 0.1), 0.25);
  EXPECT_EQ(RelativeError(0.01, 0.5, 0.1), 5);
  EXPECT_EQ(RelativeError(0, 0, 0), 0);
  EXPECT_EQ(RelativeError(0, 1, 0), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace flatlight
