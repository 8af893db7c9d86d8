// SPDX-License-Identifier: Apache-2.0
// Light of all bounces with phong lobes: do bounds hold, and how wide are they?
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <memory>
#include <vector>

#include "core/plane/path_tracing/path_tracer.h"
#include "tests/core/plane/glossy/glossy_rooms.h"
#include "tests/support/transport/honest_errors.h"
#include "tests/support/transport/solve_reference.h"
#include "tests/support/transport/trace.h"

namespace flatlight {
namespace {

TEST(GlossyBoundsTest, BoundsHoldAgainstFinerSolutionsAndAreNotFarTooWide) {
  std::vector<double> cautions;
  for (const std::uint64_t seed : {1u, 2u, 3u, 5u, 6u, 7u}) {
    const auto scene = GlossyRoom(seed);
    const SolvedGloss coarse = SolveGloss(scene, 1e-2), fine = SolveGloss(scene, 3e-4);
    ASSERT_EQ(coarse.state, GlossySolver::State::kReached) << seed;
    ASSERT_EQ(fine.state, GlossySolver::State::kReached) << seed;
    for (std::size_t i = 0; i < fine.values.size(); ++i) {
      const double error = std::abs(coarse.values[i].irradiance[0] - fine.values[i].irradiance[0]);
      const double bound = coarse.values[i].irradiance_error[0], of_fine = fine.values[i].irradiance_error[0];
      EXPECT_LE(error, bound + of_fine) << seed << ", point " << i;
      if (error > of_fine) cautions.push_back(bound / error);
    }
  }
  ASSERT_GT(cautions.size(), 10u);
  std::nth_element(cautions.begin(), cautions.begin() + static_cast<std::ptrdiff_t>(cautions.size() / 2),
                   cautions.end());
  EXPECT_LT(cautions[cautions.size() / 2], 60);
}

TEST(GlossyBoundsTest, PathTracingAgrees) {
  HonestErrors errors, of_wrong;
  for (const std::uint64_t seed : {1u, 3u, 6u}) {
    const auto scene = GlossyRoom(seed);
    const SolvedGloss solved = SolveGloss(scene, 3e-4);
    const PathTracer tracer(std::make_shared<const RayCaster>(scene), {});
    std::size_t i = 0;
    for (const Probe& probe : scene->probes()) {
      for (const Receiver& receiver : probe.receivers) {
        const MeanEstimate estimate = Trace(tracer, *scene, receiver, seed, i, 2048);
        errors.Add(estimate.mean, solved.values[i].irradiance[0], estimate.StandardError());
        of_wrong.Add(1.03 * estimate.mean, solved.values[i].irradiance[0], estimate.StandardError());
        ++i;
      }
    }
  }
  EXPECT_TRUE(errors.Unbiased()) << errors.MeanZ();
  EXPECT_TRUE(errors.RightSize()) << errors.MeanSquareZ();
  EXPECT_FALSE(of_wrong.Unbiased() && of_wrong.RightSize());
}

// A lobe without light on it changes nothing: the rest is what the solver of Lambertian curves says.
TEST(GlossyBoundsTest, LambertianCurvesReflectAsTheReferenceSays) {
  SceneMaker maker = SquareRoom({.reflectance = {0.6}}, 3);
  maker.Segment("lamp", {0.4, 0.9}, {-0.3, 0.8}, {.reflectance = {0.5}, .radiance = {1}});
  maker.Arc("ball", {{0.3, -0.4}, 0.2, 0, -2 * std::numbers::pi}, {.reflectance = {0.7}});
  ReferenceOptions options;
  options.derivatives = 0;
  options.channels = 1;
  options.target_error = 1e-8;
  const SolvedReference truth = SolveReference(maker.Build(), options);
  // Inside of a black box.
  maker.Polyline("box", {{0.2, -0.5}, {0.4, -0.5}, {0.4, -0.3}, {0.2, -0.3}}, true);
  maker.Segment("hidden", {0.25, -0.4}, {0.35, -0.4}, PhongOf(0.8, 10));
  const SolvedGloss solved = SolveGloss(maker.Build(), 1e-4);
  ASSERT_EQ(solved.state, GlossySolver::State::kReached);
  for (std::size_t i = 0; i < truth.values.size(); ++i) {
    EXPECT_LE(std::abs(solved.values[i].irradiance[0] - truth.values[i].irradiance[0]),
              solved.values[i].irradiance_error[0] + truth.values[i].irradiance_error[0]);
    EXPECT_LE(solved.values[i].irradiance_error[0], 1e-4 * solved.values[i].irradiance[0]);
  }
}

TEST(GlossyBoundsTest, ChannelsAreSolvedByThemselves) {
  const auto room = [](const SpectrumValues& reflectance) {
    SceneMaker maker = SquareRoom({.reflectance = {0.5}}, 2);
    maker.Segment("lamp", {0.4, 0.9}, {-0.3, 0.8}, {.radiance = {1}});
    maker.Segment("gloss", {-0.5, -0.6}, {0.5, -0.5}, {.material = PhongDescription{reflectance, 12}});
    return maker.Build();
  };
  const SolvedGloss all = SolveGloss(room({0.9, 0.5, 0.1}), 1e-3, 1, 3);
  for (const int c : {0, 1, 2}) {
    const SolvedGloss one = SolveGloss(room({c == 0 ? 0.9 : c == 1 ? 0.5 : 0.1}), 1e-3);
    for (std::size_t i = 0; i < one.values.size(); ++i)
      EXPECT_LE(std::abs(all.values[i].irradiance[c] - one.values[i].irradiance[0]),
                all.values[i].irradiance_error[c] + one.values[i].irradiance_error[0]);
  }
  EXPECT_GT(all.values[0].irradiance[0], 1.01 * all.values[0].irradiance[2]);
}

TEST(GlossyBoundsTest, BitsDoNotDependOnThreads) {
  const auto scene = GlossyRoom(3);
  const SolvedGloss one = SolveGloss(scene, 1e-3);
  EXPECT_GT(one.rounds, 1);
  for (const int threads : {2, 7}) {
    const SolvedGloss other = SolveGloss(scene, 1e-3, threads);
    ASSERT_EQ(other.values.size(), one.values.size());
    EXPECT_EQ(std::memcmp(other.values.data(), one.values.data(), one.values.size() * sizeof(ExactValue)), 0);
  }
}

}  // namespace
}  // namespace flatlight
