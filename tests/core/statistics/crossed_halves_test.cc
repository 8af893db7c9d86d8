// SPDX-License-Identifier: Apache-2.0
#include "core/statistics/crossed_halves.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace flatlight {
namespace {

struct Stopped {
  double crossed = 0;  // Estimate by crossed halves.
  double own = 0;      // Estimate that stops where its own error looks small.
};

// Rare bright samples: 1 with probability p, else 0. Counts double from 64 samples on.
Stopped Sample(std::uint64_t seed, double p, double target) {
  std::mt19937_64 random(seed);
  std::array<double, kReplicates> sums{};
  std::array<CrossedHalves::Target, 2> targets;
  for (auto& t : targets) t = {target, {1.0}, {0.0}};  // Floor 1: an absolute target.
  CrossedHalves crossed;
  Stopped stopped;
  bool own_stopped = false;
  std::int64_t drawn = 0;
  for (std::int64_t count = 4; !crossed.decided() || !own_stopped; count *= 2) {
    std::binomial_distribution<std::int64_t> hits(count - drawn, p);
    for (double& sum : sums) sum += static_cast<double>(hits(random));
    drawn = count;
    std::array<double, kReplicates> means;
    for (std::size_t r = 0; r < kReplicates; ++r) means[r] = sums[r] / static_cast<double>(count);
    const auto halves = std::array<CrossedHalves::HalfEstimate, 2>{
        CrossedHalves::HalfEstimate{EstimateMean(std::span(means).first(kHalfReplicates), 0)},
        CrossedHalves::HalfEstimate{EstimateMean(std::span(means).last(kHalfReplicates), 0)}};
    crossed.Offer(halves, 16.0 * static_cast<double>(count), targets);
    if (crossed.decided()) stopped.crossed = crossed.Estimate(halves, 0).mean;
    const MeanEstimate own = EstimateMean(means, 0);
    if (!own_stopped && own.StandardError() <= target) {
      own_stopped = true;
      stopped.own = own.mean;
    }
  }
  return stopped;
}

// Means over 20000 runs against the truth, in standard deviations of that mean: beyond 5 with probability 6e-7.
TEST(CrossedHalvesTest, StoppingDoesNotBiasTheEstimate) {
  constexpr double kProbability = 0.02;
  double crossed_sum = 0, crossed_squares = 0, own_sum = 0, own_squares = 0;
  constexpr int kRuns = 20'000;
  for (int run = 0; run < kRuns; ++run) {
    const Stopped stopped = Sample(static_cast<std::uint64_t>(run), kProbability, 0.01);
    crossed_sum += stopped.crossed - kProbability;
    crossed_squares += (stopped.crossed - kProbability) * (stopped.crossed - kProbability);
    own_sum += stopped.own - kProbability;
    own_squares += (stopped.own - kProbability) * (stopped.own - kProbability);
  }
  const double crossed_z = crossed_sum / std::sqrt(crossed_squares);
  const double own_z = own_sum / std::sqrt(own_squares);
  EXPECT_LT(std::abs(crossed_z), 5);
  // The test can fail: stopping by one's own error is rejected.
  EXPECT_LT(own_z, -5);
}

CrossedHalves::HalfEstimate HalfOf(double mean, double standard_error) {
  MeanEstimate estimate;
  estimate.mean = mean;
  estimate.degrees_of_freedom = 7;
  estimate.variance = standard_error * standard_error * 5 / 7;
  return {estimate};
}

constexpr std::size_t kFirst = 0;

TEST(CrossedHalvesTest, EachHalfIsDecidedByTheOther) {
  const std::array<CrossedHalves::Target, 2> targets = {CrossedHalves::Target{0.1, {0}, {0}},
                                                        CrossedHalves::Target{0.1, {0}, {0}}};
  CrossedHalves crossed;
  // The second half looks good: it decides the first, whose value is kept.
  crossed.Offer({HalfOf(1, 0.5), HalfOf(2, 0.01)}, 64, targets);
  EXPECT_FALSE(crossed.decided());
  const std::array<CrossedHalves::HalfEstimate, 2> later = {HalfOf(1.5, 0.01), HalfOf(2.5, 0.01)};
  EXPECT_EQ(crossed.Estimate(later, kFirst).mean, (1 + 2.5) / 2);
  EXPECT_EQ(crossed.Samples(128), (64 + 128) / 2);
  crossed.Offer(later, 128, targets);
  EXPECT_TRUE(crossed.decided());
  EXPECT_EQ(crossed.Estimate({HalfOf(9, 1), HalfOf(9, 1)}, kFirst).mean, (1 + 2.5) / 2);
  EXPECT_EQ(crossed.Samples(4096), (64 + 128) / 2);
  crossed.Reopen();
  EXPECT_FALSE(crossed.decided());
}

TEST(CrossedHalvesTest, FloorAppliesToDarkValues) {
  const std::array<CrossedHalves::Target, 2> targets = {CrossedHalves::Target{0.1, {1}, {0}},
                                                        CrossedHalves::Target{0.1, {1}, {0}}};
  CrossedHalves crossed;
  crossed.Offer({HalfOf(0.01, 0.09), HalfOf(0.01, 0.09)}, 64, targets);
  EXPECT_TRUE(crossed.decided());
}

TEST(CrossedHalvesTest, DarknessNeedsManySamples) {
  const std::array<CrossedHalves::Target, 2> targets = {CrossedHalves::Target{0.1, {0}, {0}},
                                                        CrossedHalves::Target{0.1, {0}, {0}}};
  CrossedHalves crossed;
  crossed.Offer({HalfOf(0, 0), HalfOf(0, 0)}, CrossedHalves::kSamplesBeforeDarkness / 2, targets);
  EXPECT_FALSE(crossed.decided());
  crossed.Offer({HalfOf(0, 0), HalfOf(0, 0)}, CrossedHalves::kSamplesBeforeDarkness, targets);
  EXPECT_TRUE(crossed.decided());
}

}  // namespace
}  // namespace flatlight
