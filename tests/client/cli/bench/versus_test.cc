// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/versus/versus.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/client/cli/bench/sample_rows.h"

namespace flatlight {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Machine {
  double slowdown = 1;     // Of every run.
  double worse = 1;        // Errors, by this factor.
  double deviation = 0.1;  // Of the logarithms of time and error.
  double bursts = 0;       // Share of runs that other work makes 1.5 times as slow.
};

constexpr int kPoints = 5;

// Five points with log-normal times and errors, and one of a method without error.
std::vector<BenchRow> Bench(std::mt19937_64& random, int runs, const Machine& machine, std::uint32_t first_seed) {
  std::normal_distribution<double> normal(0, machine.deviation);
  std::bernoulli_distribution burst(machine.bursts);
  const auto slowed = [&] { return machine.slowdown * std::exp(normal(random)) * (burst(random) ? 1.5 : 1); };
  std::vector<BenchRow> rows;
  for (int run = 0; run < runs; ++run) {
    for (int point = 0; point < kPoints; ++point) {
      const auto budget = static_cast<std::uint32_t>(16 << (2 * point));
      rows.push_back(SampleRow("s", budget, first_seed + static_cast<std::uint32_t>(run), 1e-4 * budget * slowed(),
                               machine.worse * std::exp(normal(random)) / std::sqrt(budget)));
    }
    rows.push_back(ExactRow("s", static_cast<std::uint32_t>(run), 1e-3 * slowed()));
  }
  return rows;
}

Versus Compare(const std::vector<BenchRow>& a, const std::vector<BenchRow>& b, double least = 0.05) {
  auto versus = CompareBenches(a, b, {0.01, least});
  EXPECT_TRUE(versus.ok()) << versus.status();
  return *std::move(versus);
}

bool SeesAChange(const Versus& versus) {
  return versus.SomethingIsWorse() || versus.Count(Change::kBetter) > 0 || versus.overall.verdict == Change::kBetter;
}

int FalseAlarms(const Machine& machine, int runs, int trials, double least, std::uint32_t other_seed) {
  std::mt19937_64 random(7);
  int alarms = 0;
  for (int trial = 0; trial < trials; ++trial)
    alarms +=
        SeesAChange(Compare(Bench(random, runs, machine, 0), Bench(random, runs, machine, other_seed), least)) ? 1 : 0;
  return alarms;
}

constexpr int kTrials = 1000;
// At 1 in 100 of 1000 trials 10 alarms are expected; of Poisson's distribution more than 28 come once in 10^6 times.
constexpr int kMostAlarms = 28;

// With every change counting, however small: the noise alone decides.
TEST(Versus, TheSameIsCalledTheSame) {
  EXPECT_LE(FalseAlarms({}, 16, kTrials, 0, 1000), kMostAlarms);  // Other seeds.
  EXPECT_LE(FalseAlarms({}, 16, kTrials, 0, 0), kMostAlarms);  // The same ones, with errors that do not depend on them.
  EXPECT_LE(FalseAlarms({}, 3, kTrials, 0, 1000), kMostAlarms);
  EXPECT_LE(FalseAlarms({1, 1, 0.02, 0.3}, 16, kTrials, 0, 1000), kMostAlarms);  // Noise that is far from normal.
  // The test can fail: intervals for another machine are too narrow.
  std::mt19937_64 random(8);
  EXPECT_TRUE(SeesAChange(Compare(Bench(random, 64, {}, 0), Bench(random, 64, {1.2}, 1000), 0)));
}

TEST(Versus, OfTheSameNextToNothingCounts) { EXPECT_LE(FalseAlarms({1, 1, 0.01}, 16, kTrials, 0.05, 1000), 0); }

// A slowdown of 20 % with noise of 10 %, and 48 runs: the intervals of the points reach 12 % or so to either side.
TEST(Versus, ASlowdownIsFound) {
  std::mt19937_64 random(9);
  for (int trial = 0; trial < 100; ++trial) {
    const Versus versus = Compare(Bench(random, 48, {}, 0), Bench(random, 48, {1.2}, 0));
    EXPECT_TRUE(versus.SomethingIsWorse());
    EXPECT_EQ(versus.overall.time->change, Change::kWorse);
    EXPECT_NEAR(versus.overall.time->value, 1.2, 0.1);
    EXPECT_GE(versus.Count(Change::kWorse), 3);
    const Versus back = Compare(Bench(random, 48, {1.2}, 0), Bench(random, 48, {}, 0));
    EXPECT_EQ(back.overall.time->change, Change::kBetter);
    EXPECT_FALSE(back.SomethingIsWorse());
  }
}

TEST(Versus, BurstsOfOtherWorkAreSeenThrough) {
  std::mt19937_64 random(10);
  // A third of A's runs are disturbed, none of B's: the least of 4 neighbours hardly is.
  const Versus versus = Compare(Bench(random, 40, {1, 1, 0.01, 0.33}, 0), Bench(random, 40, {1, 1, 0.01, 0}, 0));
  EXPECT_FALSE(SeesAChange(versus));
}

TEST(Versus, AWorseErrorIsFound) {
  std::mt19937_64 random(11);
  const Versus versus = Compare(Bench(random, 32, {}, 0), Bench(random, 32, {1, 1.2}, 1000));
  EXPECT_EQ(versus.overall.error->change, Change::kWorse);
  EXPECT_EQ(versus.overall.efficiency->change, Change::kWorse);
  EXPECT_NEAR(versus.overall.efficiency->value, 1 / 1.44, 0.1);
  EXPECT_TRUE(versus.SomethingIsWorse());
}

TEST(Versus, LessTimeForMoreErrorMayBeWorthIt) {
  std::mt19937_64 random(12);
  const Machine quiet{1, 1, 0.02}, traded{0.5, 1.2, 0.02};
  const Versus versus = Compare(Bench(random, 16, quiet, 0), Bench(random, 16, traded, 1000));
  EXPECT_EQ(versus.points[1].error->change, Change::kWorse);
  EXPECT_EQ(versus.points[1].time->change, Change::kBetter);
  EXPECT_EQ(versus.points[1].verdict, Change::kBetter);  // 1 / (1.44 * 0.5) = 1.39.
}

TEST(Versus, TheSameSeedsGiveTheSameErrors) {
  std::mt19937_64 random(13);
  const std::vector<BenchRow> a = Bench(random, 8, {}, 0);
  std::vector<BenchRow> b = a;
  std::reverse(b.begin(), b.end());  // In another order.
  const Versus versus = Compare(a, b);
  EXPECT_EQ(versus.points[1].error->value, 1);
  EXPECT_EQ(versus.points[1].error->low, versus.points[1].error->high);
}

TEST(Versus, TooNoisyTellsHowManyRunsWouldDo) {
  std::mt19937_64 random(14);
  const Versus versus = Compare(Bench(random, 4, {1, 1, 0.3}, 0), Bench(random, 4, {1, 1, 0.3}, 1000));
  EXPECT_GT(versus.Count(Change::kTooNoisy), 3);
  const int needed = *versus.points[1].runs_needed;
  // Student's t of 0.01 / 19 is 3.5, and 3.5 * 0.3 * sqrt(2 / n) = log(1.2) for n = 66; 4 runs know the noise to a
  // third.
  EXPECT_GT(needed, 15);
  EXPECT_LT(needed, 300);
  const Versus one = Compare(Bench(random, 1, {}, 0), Bench(random, 1, {}, 1000));
  EXPECT_EQ(one.points[1].verdict, Change::kTooNoisy);
  EXPECT_FALSE(one.points[1].runs_needed);
}

TEST(Versus, AMethodThatIsNoLongerExact) {
  std::vector<BenchRow> a, b;
  for (std::uint32_t repeat = 0; repeat < 4; ++repeat) {
    a.push_back(ExactRow("s", repeat, 1));
    b.push_back(ExactRow("s", repeat, 1));
    b.back().errors[1] = QuantityError{1e-3, 1e-3, 1e-3, {}, {}, 0, {}};
  }
  EXPECT_FALSE(SeesAChange(Compare(a, a)));
  const Versus versus = Compare(a, b);
  ASSERT_EQ(versus.points.size(), 2U);
  EXPECT_EQ(versus.points[0].verdict, Change::kNotSeen);
  EXPECT_EQ(versus.points[1].quantity, BenchQuantity::kGradient);
  EXPECT_EQ(versus.points[1].verdict, Change::kWorse);
}

TEST(Versus, DifferentMachinesAreTold) {
  std::mt19937_64 random(15);
  const std::vector<BenchRow> a = Bench(random, 8, {}, 0);
  std::vector<BenchRow> b = a;
  for (BenchRow& row : b) {
    row.processor = "another";
    row.cpu_seconds *= 3;
  }
  const Versus versus = Compare(a, b);
  EXPECT_THAT(versus.notes, Contains(HasSubstr("different machines, so that only errors are compared")));
  EXPECT_FALSE(versus.points[1].time || versus.points[1].efficiency);
  EXPECT_TRUE(versus.points[1].error);
  EXPECT_FALSE(versus.SomethingIsWorse());
}

TEST(Versus, WhatIsNotComparedIsTold) {
  std::mt19937_64 random(16);
  const std::vector<BenchRow> a = Bench(random, 4, {}, 0);
  EXPECT_THAT(Compare(a, a).notes, IsEmpty());
  std::vector<BenchRow> b = a;
  for (BenchRow& row : b) {
    if (row.budget == 16U) row.budget = 17;
    if (row.method == "exact") row.settings = "--derivatives none";
  }
  Versus versus = Compare(a, b);
  EXPECT_THAT(versus.notes, Contains("1 point of A not compared: s path-tracing: no such budget in B"));
  EXPECT_THAT(versus.notes, Contains(HasSubstr("1 point of B not compared: s exact: other settings")));
  EXPECT_EQ(versus.points.size(), 4U);
  for (BenchRow& row : b) row.scene_hash = "new";
  const auto nothing = CompareBenches(a, b, {});
  EXPECT_THAT(nothing.status().ToString(), HasSubstr("no point in common"));
  EXPECT_THAT(nothing.status().ToString(), HasSubstr("the scene is another one"));
  EXPECT_FALSE(CompareBenches(a, {}, {}).ok());
}

TEST(Versus, RowsOfOtherBuildsAreLeftOut) {
  std::mt19937_64 random(17);
  const std::vector<BenchRow> a = Bench(random, 8, {}, 0);
  std::vector<BenchRow> mixed = Bench(random, 4, {}, 0);
  for (BenchRow& row : mixed) row.server = "old";
  mixed.insert(mixed.end(), a.begin(), a.end());
  const Versus versus = Compare(mixed, a);
  EXPECT_EQ(versus.points[0].runs_a, 8);
  EXPECT_THAT(versus.notes, Contains(HasSubstr("24 rows of A left out")));
}

}  // namespace
}  // namespace flatlight
