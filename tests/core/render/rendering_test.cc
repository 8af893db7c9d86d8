// SPDX-License-Identifier: Apache-2.0
// Whole renderings: equal bits however they are worked on, and what a field holds.
#include "core/render/rendering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/execution/thread_pool.h"
#include "core/render/plan.h"
#include "tests/support/transport/render.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

TEST(RenderingTest, BitsDependOnNothingButTheBlocksDone) {
  const auto scene = FurnishedRoom(false, 5).Build();
  Settings target = Sampled(4096);
  target.target_error = 0.1;
  Settings exact;
  exact.max_bounces = 0;
  for (const Settings& settings : {Sampled(300), target, exact}) {
    const Ended reference = Render(scene, settings);
    EXPECT_GT(reference.field->probes[0].irradiance[0], 0);
    for (const int threads : {1, 2, 7}) {
      for (const Clock::Duration budget :
           {Clock::Duration(0), Clock::Duration(std::chrono::milliseconds(1)), kForever}) {
        const Ended other = Render(scene, settings, threads, budget);
        EXPECT_EQ(HashOf(*other.field), HashOf(*reference.field)) << threads << " threads";
        EXPECT_EQ(other.field->rays, reference.field->rays);
      }
    }
  }
}

TEST(RenderingTest, SeedsAndPointsDiffer) {
  const auto scene = SquareRoom({.reflectance = {0.3}, .radiance = {1}}, 2).Build();
  const Ended first = Render(scene, Sampled(64, 1));
  EXPECT_NE(HashOf(*first.field), HashOf(*Render(scene, Sampled(64, 2)).field));
  EXPECT_NE(first.field->probes[0].irradiance[0], first.field->probes[2].irradiance[0]);
}

TEST(RenderingTest, SamplesAreRoundedUpToBlocks) {
  const auto scene = SquareRoom({.reflectance = {0.3}, .radiance = {1}}, 2).Build();
  const Ended ended = Render(scene, Sampled(1000));
  EXPECT_EQ(ended.reason, EndReason::kSamplesDone);
  for (const ProbeField& probe : ended.field->probes) {
    EXPECT_EQ(probe.samples, std::vector<double>(2, 1008));
  }
}

TEST(RenderingTest, SamplesLimitATargetError) {
  const auto scene = SquareRoom({.reflectance = {0.6}, .radiance = {1}}, 1).Build();
  Settings settings = Sampled(200);
  settings.target_error = 1e-6;
  const Ended ended = Render(scene, settings);
  EXPECT_EQ(ended.reason, EndReason::kSamplesDone);
  EXPECT_EQ(ended.field->probes[0].samples[0], 208);
}

TEST(RenderingTest, FieldsAreInWorldUnits) {
  // The same scene, a thousand times as large and a million times as bright.
  const auto make = [](double size, double light) {
    SceneMaker maker;
    maker.Segment("floor", {0, 0}, {size, 0});
    maker.Segment("light", {size, size}, {0.5 * size, size}, {.radiance = {light}});
    maker.Probe("floor", 3);
    return maker.Build();
  };
  Settings exact;
  const Ended small = Render(make(1, 1), exact);
  const Ended large = Render(make(1000, 1e6), exact);
  const Ended sampled = Render(make(1000, 1e6), Sampled(64));
  for (std::size_t i = 0; i < 3; ++i) {
    const ProbeField& a = small.field->probes[0];
    const ProbeField& b = large.field->probes[0];
    EXPECT_NEAR(b.irradiance[i] / a.irradiance[i], 1e6, 1e-6);
    EXPECT_NEAR(b.gradient[i] / a.gradient[i], 1e3, 1e-9);
    EXPECT_NEAR(b.hessian[i] / a.hessian[i], 1, 1e-9);
    EXPECT_NEAR(sampled.field->probes[0].irradiance[i], b.irradiance[i], 1e-9 * b.irradiance[i]);
  }
  ASSERT_TRUE(large.field->error_bound.has_value());
  EXPECT_LT(*large.field->error_bound, 1e-6);
  EXPECT_EQ(large.reason, EndReason::kConverged);
}

TEST(RenderingTest, ExactShowsNoUnfinishedProbe) {
  const auto scene = FurnishedRoom(true, 200).Build();
  Settings exact;
  exact.max_bounces = 0;
  const std::unique_ptr<Rendering> rendering = StartRendering(scene, PlanFor(*scene, exact));
  InlineExecutor executor;
  const SteadyClock clock;
  const Cancellation never;
  bool seen_unfinished = false;
  while (!rendering->done()) {
    rendering->Advance(executor, never, clock, Clock::Duration(0));
    const std::shared_ptr<const Field> field = rendering->Snapshot();
    for (const ProbeField& probe : field->probes) {
      EXPECT_TRUE(probe.irradiance.empty() || probe.irradiance.size() == 200);
      seen_unfinished = seen_unfinished || probe.irradiance.empty();
    }
  }
  EXPECT_TRUE(seen_unfinished);
  EXPECT_EQ(rendering->Progress().fraction, 1);
}

// Works alone, and cancels after a number of pieces of work.
class CancellingExecutor final : public Executor {
 public:
  CancellingExecutor(int pieces, Cancellation& cancellation) : left_(pieces), cancellation_(cancellation) {}
  int threads() const override { return 1; }
  void ParallelFor(std::size_t count, int, const std::function<void(std::size_t)>& work) override {
    for (std::size_t i = 0; i < count; ++i) {
      if (left_-- == 0) cancellation_.Cancel();
      work(i);
    }
  }

 private:
  int left_;
  Cancellation& cancellation_;
};

TEST(RenderingTest, ACancelledCallLeavesWholeBlocksAndCanGoOn) {
  const auto scene = FurnishedRoom(false, 5).Build();
  Settings exact;
  exact.max_bounces = 0;
  for (const Settings& settings : {Sampled(300), exact}) {
    const Ended reference = Render(scene, settings);
    for (const int pieces : {0, 1, 7, 13}) {
      const std::unique_ptr<Rendering> rendering = StartRendering(scene, PlanFor(*scene, settings));
      const SteadyClock clock;
      Cancellation cancellation;
      CancellingExecutor executor(pieces, cancellation);
      rendering->Advance(executor, cancellation, clock, kForever);
      EXPECT_FALSE(rendering->done());
      InlineExecutor rest;
      const Cancellation never;
      rendering->Advance(rest, never, clock, kForever);
      ASSERT_TRUE(rendering->done());
      EXPECT_EQ(HashOf(*rendering->Snapshot()), HashOf(*reference.field)) << pieces;
    }
  }
}

// Where light hardly fades one path takes 10^4 rays. Cancelled before it starts, or a few rays later, none goes on.
TEST(RenderingTest, CancellationStopsWithinAPath) {
  const auto scene = SquareRoom({.reflectance = {0.9999}, .radiance = {1}}, 2).Build();
  const std::unique_ptr<Rendering> rendering = StartRendering(scene, PlanFor(*scene, Sampled(1024)));
  const SteadyClock clock;
  Cancellation cancellation;
  CancellingExecutor executor(0, cancellation);
  rendering->Advance(executor, cancellation, clock, kForever);
  EXPECT_EQ(rendering->Snapshot()->rays, 0);
  EXPECT_EQ(rendering->Snapshot()->probes[0].samples[0], 0);
}

}  // namespace
}  // namespace flatlight
