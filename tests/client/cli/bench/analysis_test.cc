// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "client/cli/bench/analysis/curve.h"
#include "client/cli/bench/analysis/findings.h"
#include "client/cli/bench/analysis/time_to.h"
#include "tests/client/cli/bench/sample_rows.h"

namespace flatlight {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Error 0.1 sqrt(16 / budget), time 1 ms * budget / 16; the seeds scatter by 10 % around that.
std::vector<BenchRow> SampledRows() {
  std::vector<BenchRow> rows;
  for (const std::uint32_t budget : {256U, 16U, 64U})  // The order does not matter.
    for (const std::uint32_t seed : {1U, 2U})
      for (const std::uint32_t repeat : {0U, 1U}) {
        const double square = 0.01 * 16 / budget * (seed == 1 ? 1.1 : 0.9);
        rows.push_back(SampleRow("s", budget, seed, 1e-3 * budget / 16 * (1 + repeat), std::sqrt(square)));
        rows.back().repeat = repeat;
      }
  return rows;
}

TEST(Analysis, PointsOfACurve) {
  const std::vector<Curve> curves = CurvesOf(SampledRows());
  ASSERT_EQ(curves.size(), 1U);
  ASSERT_EQ(curves[0].points.size(), 3U);
  const PointSummary& point = curves[0].points[1];
  EXPECT_EQ(point.budget, 64U);
  EXPECT_EQ(point.runs, 4);
  EXPECT_EQ(point.seeds, 2);
  EXPECT_NEAR(point.cpu_least, 4e-3, 1e-15);
  EXPECT_NEAR(point.cpu_median, 6e-3, 1e-15);
  EXPECT_NEAR(point.wall_median, 3e-3, 1e-15);
  EXPECT_NEAR(point.rms, 0.05, 1e-12);
  EXPECT_NEAR(point.relative, 0.05, 1e-12);
  EXPECT_NEAR(*point.Efficiency(), 1 / (0.0025 * 6e-3), 1e-6);
  // Squares 0.9 and 1.1 of the mean: variance 0.02, of the mean 0.01, of the logarithm of the root a quarter of that.
  EXPECT_NEAR(point.log_variance, 0.01 / 4, 1e-12);
}

TEST(Analysis, SlopeOfACurve) {
  const Curve curve = CurvesOf(SampledRows())[0];
  EXPECT_NEAR(curve.over_time->slope.value, -0.5, 1e-12);
  EXPECT_NEAR(curve.over_samples->slope.value, -0.5, 1e-12);
  EXPECT_THAT(FindingsOf({curve}), IsEmpty());
}

TEST(Analysis, OwnErrorOfTheTruthIsTakenOut) {
  std::vector<BenchRow> rows;
  for (const std::uint32_t seed : {1U, 2U}) {
    rows.push_back(SampleRow("s", 16, seed, 1, 0.5));
    rows.back().errors[0]->truth_rms = 0.3;
  }
  const PointSummary point = CurvesOf(rows)[0].points[0];
  EXPECT_NEAR(point.rms, 0.4, 1e-12);
  EXPECT_NEAR(point.relative, 0.4, 1e-12);
  EXPECT_NEAR(point.truth_relative, 0.3, 1e-12);
}

TEST(Analysis, TimeToAnError) {
  using Source = TimeTo::Source;
  const Curve curve = CurvesOf(SampledRows())[0];  // 10 % in 1.5 ms, 5 % in 6 ms, 2.5 % in 24 ms.
  const auto at = [&curve](double error) { return TimeToError(curve, error); };
  EXPECT_EQ(at(0.2).source, Source::kAtMost);
  EXPECT_NEAR(at(0.2).seconds, 1.5e-3, 1e-12);
  EXPECT_EQ(at(0.0301).source, Source::kMeasured);
  EXPECT_NEAR(at(0.04).seconds, 6e-3 * std::pow(0.05 / 0.04, 2), 1e-12);
  EXPECT_EQ(at(0.01).source, Source::kExtrapolated);
  EXPECT_NEAR(at(0.01).seconds, 24e-3 * 6.25, 1e-9);
}

TEST(Analysis, AFitInDoubtExtrapolatesNothing) {
  std::vector<BenchRow> rows;
  for (const auto& [budget, error] : {std::pair(16U, 0.1), {64U, 0.09}, {256U, 0.02}})
    rows.push_back(SampleRow("s", budget, 1, budget, error));
  EXPECT_EQ(TimeToError(CurvesOf(rows)[0], 0.01).source, TimeTo::Source::kUnknown);
  rows.pop_back();
  EXPECT_EQ(TimeToError(CurvesOf(rows)[0], 0.01).source, TimeTo::Source::kUnknown);
}

TEST(Analysis, AMethodWithoutError) {
  const std::vector<Curve> curves = CurvesOf({ExactRow("s", 0, 3), ExactRow("s", 1, 1), ExactRow("s", 2, 2)});
  ASSERT_EQ(curves.size(), 2U);  // And the gradient.
  EXPECT_TRUE(curves[0].IsExact());
  EXPECT_EQ(curves[0].points[0].runs, 3);
  EXPECT_EQ(curves[0].points[0].seeds, 1);
  EXPECT_FALSE(curves[0].over_time || curves[0].points[0].Efficiency());
  EXPECT_EQ(TimeToError(curves[0], 1e-4).source, TimeTo::Source::kMeasured);
  EXPECT_EQ(TimeToError(curves[0], 1e-4).seconds, 2);
}

TEST(Analysis, FindingsTellOfErrorsThatAreStatedTooSmall) {
  std::vector<BenchRow> rows;
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    rows.push_back(SampleRow("s", 16, seed, 1, 0.1));
    rows.back().errors[0]->mean_z2 = 2 + 0.01 * seed;
  }
  EXPECT_THAT(FindingsOf(CurvesOf(rows)), ElementsAre(HasSubstr("s path-tracing 16: states its errors too small")));
}

TEST(Analysis, FindingsTellOfBiasAndOfSlowConvergence) {
  std::vector<BenchRow> rows;
  for (const std::uint32_t budget : {16U, 64U, 256U, 1024U})
    for (std::uint32_t seed = 0; seed < 4; ++seed) {
      // Down to an error of 0.1 that does not go away.
      rows.push_back(SampleRow("s", budget, seed, budget, 0.1 * std::pow(budget, -0.1)));
      rows.back().errors[0]->sketch.assign(Sketch::kProjections, 0.1 + 1e-3 * seed);
    }
  const std::vector<std::string> findings = FindingsOf(CurvesOf(rows));
  ASSERT_EQ(findings.size(), 5U);
  EXPECT_THAT(findings[0], HasSubstr("s path-tracing 16: biased"));
  EXPECT_THAT(findings[4], HasSubstr("converges slower than by chance: the error falls as time to the -0.1"));
}

}  // namespace
}  // namespace flatlight
