// SPDX-License-Identifier: Apache-2.0
#include "client/cli/comparison/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/client/cli/formats/sample_result.h"

namespace flatlight {
namespace {

using ::testing::HasSubstr;

constexpr int kPoints = 256;

// Truth 1 at every point, deterministic with error bound 0.
v1::RenderResult Truth() {
  v1::RenderResult result;
  v1::ProbeResult& probe = AddProbe(result, "floor", kPoints);
  for (double& value : *probe.mutable_irradiance()) value = 1;
  result.mutable_statistics()->set_error_bound(0);
  return result;
}

// Estimates of it: errors from Student's distribution, which a standard error of 16 replicates gives, times `scale`.
v1::RenderResult Estimate(unsigned seed, double bias = 0, double scale = 1) {
  v1::RenderResult result = Truth();
  result.clear_statistics();
  std::mt19937_64 random(seed);
  std::student_t_distribution<double> student(kDegreesOfFreedom);
  v1::ProbeResult& probe = *result.mutable_probes(0);
  for (double& value : *probe.mutable_irradiance()) {
    value += 0.01 * (scale * student(random) + bias);
    probe.add_standard_error(0.01);
  }
  return result;
}

bool Equal(const v1::RenderResult& a, const v1::RenderResult& b, std::optional<double> tolerance = {}) {
  const auto comparison = Compare(a, b, tolerance);
  EXPECT_TRUE(comparison.ok()) << comparison.status();
  return comparison.ok() && comparison->Equal();
}

// 300 right results at a failure rate of 1e-4 each: the chance of any failure is 3 %, and the seeds are fixed.
TEST(Compare, RightResultsAgree) {
  for (unsigned seed = 0; seed < 150; ++seed) {
    EXPECT_TRUE(Equal(Estimate(seed), Truth())) << seed;
    EXPECT_TRUE(Equal(Estimate(seed), Estimate(seed + 1000))) << seed;
  }
}

TEST(Compare, BiasesAreFound) {
  // Of one standard error everywhere: 16 standard deviations of the mean.
  EXPECT_FALSE(Equal(Estimate(1, 1), Truth()));
  const auto comparison = Compare(Estimate(1, 1), Truth(), {});
  EXPECT_THAT(comparison->quantities[0].difference, HasSubstr("mean z"));
  EXPECT_NEAR(*comparison->quantities[0].mean_z, 1, 0.3);
}

TEST(Compare, ErrorsThatAreStatedTooSmallAreFound) {
  EXPECT_FALSE(Equal(Estimate(2, 0, 2), Truth()));
  EXPECT_TRUE(Equal(Estimate(2, 0, 0.5), Truth()));
}

TEST(Compare, OneWrongPointIsFound) {
  v1::RenderResult result = Estimate(3);
  result.mutable_probes(0)->set_irradiance(17, 1.2);
  const auto comparison = Compare(result, Truth(), {});
  EXPECT_THAT(comparison->quantities[0].difference, HasSubstr("irradiance[17] is 1.2, not 1"));
  EXPECT_EQ(comparison->quantities[0].largest_index, 17);
}

// Points that a time limit left without samples: their 0 is no value.
TEST(Compare, PointsWithoutSamplesAreLeftOut) {
  v1::RenderResult estimate = Estimate(1);
  v1::ProbeResult& probe = *estimate.mutable_probes(0);
  for (int i = 0; i < kPoints; ++i) probe.add_samples(i < 100 ? 16 : 0);
  for (int i = 100; i < kPoints; ++i) probe.set_irradiance(i, 0), probe.set_standard_error(i, 0);
  const auto comparison = Compare(estimate, Truth(), {});
  ASSERT_TRUE(comparison.ok());
  EXPECT_TRUE(comparison->Equal());
  EXPECT_EQ(comparison->quantities[0].values, 100);
  for (double& samples : *probe.mutable_samples()) samples = 0;
  EXPECT_FALSE(Compare(estimate, Truth(), {}).ok());
}

TEST(Compare, BoundsOfDeterministicResultsCount) {
  v1::RenderResult result = Truth();
  result.mutable_probes(0)->set_irradiance(0, 1 + 1e-6);
  EXPECT_FALSE(Equal(result, Truth()));
  result.mutable_statistics()->set_error_bound(2e-6);
  EXPECT_TRUE(Equal(result, Truth()));
  result.mutable_probes(0)->set_irradiance(0, 1 + 1e-14);  // Rounding.
  result.mutable_statistics()->set_error_bound(0);
  EXPECT_TRUE(Equal(result, Truth()));
}

TEST(Compare, ToleranceIsRelativeWithAFloor) {
  v1::RenderResult result = Truth(), reference = Truth();
  result.mutable_probes(0)->set_irradiance(0, 1.05);
  EXPECT_TRUE(Equal(result, reference, 0.06));
  EXPECT_FALSE(Equal(result, reference, 0.04));
  reference.mutable_probes(0)->set_irradiance(1, 0);  // Dark: measured against 1 % of the mean.
  result.mutable_probes(0)->set_irradiance(1, 0.0005);
  EXPECT_TRUE(Equal(result, reference, 0.06));
  result.mutable_probes(0)->set_irradiance(1, 0.0007);
  EXPECT_FALSE(Equal(result, reference, 0.06));
  EXPECT_TRUE(Equal(reference, reference, 0));
}

TEST(Compare, DerivativesAreJudgedWhereBothHaveThem) {
  v1::RenderResult a = Truth(), b = Truth();
  for (int i = 0; i < kPoints; ++i) {
    a.mutable_probes(0)->add_gradient(2);
    b.mutable_probes(0)->add_gradient(2.5);
    a.mutable_probes(0)->add_hessian(1);
  }
  const auto comparison = Compare(a, b, {});
  ASSERT_EQ(comparison->quantities.size(), 2U);
  EXPECT_EQ(comparison->quantities[1].quantity, "gradient");
  EXPECT_FALSE(comparison->Equal());
  EXPECT_NEAR(comparison->quantities[1].rms, 0.5, 1e-12);
  EXPECT_NEAR(*comparison->quantities[1].relative_rms, 0.2, 1e-12);
}

TEST(Compare, OtherProbesCannotBeCompared) {
  const auto message = [](const v1::RenderResult& a) {
    const auto comparison = Compare(a, Truth(), {});
    EXPECT_FALSE(comparison.ok());
    return std::string(comparison.status().message().data(), comparison.status().message().size());
  };
  v1::RenderResult other = Truth();
  other.mutable_probes(0)->set_name("wall");
  EXPECT_THAT(message(other), HasSubstr("'floor' is in B only"));
  other = Truth();
  AddProbe(other, "wall", 1);
  EXPECT_THAT(message(other), HasSubstr("'wall' is in A only"));
  other = Truth();
  other.mutable_probes(0)->set_positions(6, 3.1);
  EXPECT_THAT(message(other), HasSubstr("point 3 is elsewhere"));
  other.clear_probes();
  AddProbe(other, "floor", 3);
  EXPECT_THAT(message(other), HasSubstr("3 and 256 points"));
}

TEST(Compare, OrderOfProbesDoesNotCount) {
  v1::RenderResult a, b;
  AddProbe(a, "x", 2);
  AddProbe(a, "y", 3);
  AddProbe(b, "y", 3);
  AddProbe(b, "x", 2);
  EXPECT_TRUE(Equal(a, b));
}

}  // namespace
}  // namespace flatlight
