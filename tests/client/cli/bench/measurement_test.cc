// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/measurement/measurement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "client/cli/bench/measurement/sketch.h"
#include "tests/client/cli/formats/sample_result.h"

namespace flatlight {
namespace {

using ::testing::HasSubstr;

const QuantityError& Irradiance(const BenchRow& row) { return *row.ErrorOf(BenchQuantity::kIrradiance); }

// Two probes of 2 and 1 points; the truth is 1, 1/2 and 1.
v1::RenderResult Truth() {
  v1::RenderResult result;
  AddProbe(result, "floor", 2);
  AddProbe(result, "wall", 1);
  return result;
}

TEST(Measurement, ErrorsAreOverAllProbes) {
  v1::RenderResult result = Truth();
  result.mutable_probes(0)->set_irradiance(0, 1.3);
  result.mutable_probes(1)->set_irradiance(0, 0.6);
  for (v1::ProbeResult& probe : *result.mutable_probes())
    for (unsigned i = 0; i < probe.count(); ++i) probe.add_standard_error(0.1);
  result.mutable_statistics()->set_wall_seconds(1);
  result.mutable_statistics()->set_cpu_seconds(2);
  result.mutable_statistics()->set_rays(3);
  result.set_end_reason(v1::SAMPLES_DONE);
  BenchRow row;
  ASSERT_TRUE(Measure(result, Truth(), row).ok());
  EXPECT_NEAR(Irradiance(row).rms, std::sqrt((0.09 + 0.16) / 3), 1e-15);
  EXPECT_NEAR(Irradiance(row).largest, 0.4, 1e-15);
  EXPECT_NEAR(Irradiance(row).relative, std::sqrt((0.09 + 0.16) / 2.25), 1e-15);
  EXPECT_NEAR(*Irradiance(row).mean_z, (3 - 4) / 3.0, 1e-12);
  EXPECT_NEAR(*Irradiance(row).mean_z2, (9 + 16) / 3.0, 1e-12);
  EXPECT_EQ(Irradiance(row).truth_rms, 0);
  EXPECT_FALSE(row.ErrorOf(BenchQuantity::kGradient));
  EXPECT_EQ(row.wall_seconds, 1);
  EXPECT_EQ(row.cpu_seconds, 2);
  EXPECT_EQ(row.rays, 3);
  EXPECT_EQ(row.end_reason, "samples-done");
}

TEST(Measurement, ErrorOfTheTruthCountsToo) {
  v1::RenderResult truth = Truth(), result = Truth();
  for (v1::ProbeResult& probe : *truth.mutable_probes())
    for (unsigned i = 0; i < probe.count(); ++i) probe.add_standard_error(0.3);
  for (v1::ProbeResult& probe : *result.mutable_probes())
    for (unsigned i = 0; i < probe.count(); ++i) {
      probe.set_irradiance(static_cast<int>(i), probe.irradiance(static_cast<int>(i)) + 0.5);
      probe.add_standard_error(0.4);
    }
  BenchRow row;
  ASSERT_TRUE(Measure(result, truth, row).ok());
  EXPECT_NEAR(*Irradiance(row).mean_z, 1, 1e-12);  // 0.5 / hypot(0.3, 0.4).
  EXPECT_NEAR(Irradiance(row).truth_rms, 0.3, 1e-15);
  EXPECT_NEAR(Irradiance(row).OwnRms(), 0.4, 1e-15);
  EXPECT_NEAR(Irradiance(row).OwnRelative(), 0.4 / std::sqrt(0.75), 1e-15);
}

TEST(Measurement, WhatIsStatedExactlyHasNoZ) {
  v1::RenderResult result = Truth();
  for (v1::ProbeResult& probe : *result.mutable_probes())
    for (unsigned i = 0; i < probe.count(); ++i) probe.add_standard_error(1e-14);
  BenchRow row;
  ASSERT_TRUE(Measure(result, Truth(), row).ok());
  EXPECT_FALSE(Irradiance(row).mean_z);
  EXPECT_EQ(Irradiance(row).relative, 0);
}

TEST(Measurement, DarkTruth) {
  v1::RenderResult truth = Truth(), result = Truth();
  for (v1::ProbeResult& probe : *truth.mutable_probes())
    for (double& value : *probe.mutable_irradiance()) value = 0;
  BenchRow row;
  ASSERT_TRUE(Measure(result, truth, row).ok());
  EXPECT_EQ(Irradiance(row).relative, 1);
}

TEST(Measurement, OtherProbesAreRefused) {
  v1::RenderResult other = Truth();
  other.mutable_probes(1)->set_name("lamp");
  BenchRow row;
  EXPECT_THAT(Measure(Truth(), other, row).ToString(), HasSubstr("'lamp'"));
}

constexpr int kPoints = 256;
constexpr int kRuns = 8;

// Sketches of runs with errors of deviation 1 (half of them 3: points are not alike), and of what all have in common.
std::vector<std::vector<double>> Sketches(std::mt19937_64& random, double bias) {
  std::normal_distribution<double> normal;
  std::vector<double> common(kPoints);
  for (double& value : common) value = bias * normal(random);
  std::vector<std::vector<double>> sketches;
  for (int run = 0; run < kRuns; ++run) {
    Sketch sketch;
    for (int i = 0; i < kPoints; ++i)
      sketch.Add(common[static_cast<std::size_t>(i)] + (i % 2 == 0 ? 1 : 3) * normal(random));
    sketches.push_back(sketch.Projections());
  }
  return sketches;
}

TEST(Sketch, KeepsTheRms) {
  std::mt19937_64 random(3);
  double square = 0;
  for (int trial = 0; trial < 200; ++trial)
    for (const std::vector<double>& sketch : Sketches(random, 0))
      for (const double value : sketch) square += value * value / (200.0 * kRuns * Sketch::kProjections);
  // 51 200 squares of variance 2 * 5^2: a deviation of 0.031 of the mean, of which 5.
  EXPECT_NEAR(square, 5, 5 * 0.032);
}

// Without bias the probability is uniform: below 0.01 in 20 of 2000 cases, with a deviation of 4.4; 5 of these.
TEST(Sketch, NoiseIsNotTakenForBias) {
  std::mt19937_64 random(4);
  int found = 0;
  double ratio = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const auto bias = EstimateBias(Sketches(random, 0), 0);
    found += bias->probability < 0.01 ? 1 : 0;
    ratio += bias->rms * bias->rms / (bias->noise_rms * bias->noise_rms) / 2000;
  }
  EXPECT_NEAR(found, 20, 5 * 4.5);
  EXPECT_NEAR(ratio, 1, 0.04);  // F has mean 224/222 and deviation 0.27.
}

// The noise of the mean of 8 runs is sqrt(5/8) = 0.79. A bias of 1.6 makes F five times as large: found every time.
TEST(Sketch, BiasIsFound) {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 200; ++trial) {
    const auto bias = EstimateBias(Sketches(random, 1.6), 0);
    EXPECT_LT(bias->probability, 0.01);
    EXPECT_NEAR(bias->rms, std::sqrt(1.6 * 1.6 + 5.0 / 8), 5 * 0.25);
    // Were it the truth that is off by so much, it would be no bias of the runs.
    EXPECT_GT(EstimateBias(Sketches(random, 1.6), 1.6)->probability, 1e-6);
  }
}

TEST(Sketch, NeedsTwoRuns) {
  std::mt19937_64 random(6);
  const auto sketches = Sketches(random, 0);
  EXPECT_FALSE(EstimateBias({sketches[0]}, 0));
  EXPECT_FALSE(EstimateBias({sketches[0], {}}, 0));
  EXPECT_EQ(EstimateBias({sketches[0], sketches[0]}, 0)->probability, 0);  // The same, and off: no noise explains it.
  const std::vector<double> zero(Sketch::kProjections);
  EXPECT_EQ(EstimateBias({zero, zero}, 0)->probability, 1);
}

}  // namespace
}  // namespace flatlight
