// SPDX-License-Identifier: Apache-2.0
// Whole renderings: equal bits however they are worked on, errors that tell the truth, skips that change nothing.
#include "core/render/rendering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/execution/thread_pool.h"
#include "core/render/plan.h"
#include "core/render/skips.h"
#include "tests/support/transport/honest_errors.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

constexpr Clock::Duration kForever = Clock::Duration::max();

Plan PlanFor(const Scene& scene, const Settings& settings) {
  Diagnostics diagnostics;
  std::optional<Plan> plan = MakePlan(scene, settings, diagnostics);
  EXPECT_TRUE(plan.has_value()) << (diagnostics.empty() ? "" : diagnostics.kept()[0].message);
  return plan.value_or(Plan());
}

struct Ended {
  std::shared_ptr<const Field> field;
  EndReason reason = EndReason::kConverged;
};

Ended Render(const std::shared_ptr<const Scene>& scene, const Settings& settings, int threads = 1,
             Clock::Duration budget = kForever) {
  const std::unique_ptr<Rendering> rendering = StartRendering(scene, PlanFor(*scene, settings));
  ThreadPool pool(threads);
  const SteadyClock clock;
  const Cancellation never;
  while (!rendering->done()) rendering->Advance(pool, never, clock, budget);
  return {rendering->Snapshot(), rendering->end_reason()};
}

// FNV-1a over the bits of all values.
std::uint64_t HashOf(const Field& field) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const ProbeField& probe : field.probes) {
    for (const std::vector<double>* values : {&probe.irradiance, &probe.standard_error, &probe.gradient, &probe.hessian,
                                              &probe.gradient_error, &probe.hessian_error, &probe.samples}) {
      for (const double value : *values) {
        std::uint64_t bits;
        std::memcpy(&bits, &value, sizeof(bits));
        hash = (hash ^ bits) * 0x100000001b3u;
      }
    }
  }
  return hash;
}

Settings Sampled(std::uint32_t samples, std::uint32_t seed = 0) {
  Settings settings;
  settings.method = Method::kPathTracing;
  settings.samples = samples;
  settings.seed = seed;
  return settings;
}

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

// A furnace with much noise; 16 points, 40 seeds: 640 values.
TEST(RenderingTest, StatedErrorsTellTheTruth) {
  const auto scene = SquareRoom({.reflectance = {0.6}, .radiance = {1}}, 4).Build();
  HonestErrors errors;
  HonestErrors wrong;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    const Ended ended = Render(scene, Sampled(256, seed));
    for (const ProbeField& probe : ended.field->probes) {
      for (std::size_t i = 0; i < probe.irradiance.size(); ++i) {
        errors.Add(probe.irradiance[i], 5, probe.standard_error[i]);
        wrong.Add(1.02 * probe.irradiance[i], 5, probe.standard_error[i]);
      }
    }
  }
  EXPECT_EQ(errors.count(), 640u);
  EXPECT_TRUE(errors.Unbiased()) << errors.MeanZ();
  EXPECT_TRUE(errors.RightSize()) << errors.MeanSquareZ();
  EXPECT_FALSE(wrong.Unbiased()) << "2 % more light must be noticed";
}

// A furnace for each channel: E = 2 Le / (1 - rho).
TEST(RenderingTest, ChannelsAreIndependent) {
  const std::vector<double> reflectance = {0.2, 0.5, 0.7};
  const std::vector<double> radiance = {1, 3, 0.5};
  const auto scene = SquareRoom({.reflectance = reflectance, .radiance = radiance}, 4).Build();
  std::array<HonestErrors, 3> errors;
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const Ended ended = Render(scene, Sampled(128, seed));
    for (const ProbeField& probe : ended.field->probes) {
      ASSERT_EQ(probe.irradiance.size(), 12u);
      for (std::size_t i = 0; i < 12; ++i) {
        const std::size_t c = i % 3;
        errors[c].Add(probe.irradiance[i], 2 * radiance[c] / (1 - reflectance[c]), probe.standard_error[i]);
      }
    }
  }
  for (const HonestErrors& channel : errors) EXPECT_TRUE(channel.Unbiased()) << channel.MeanZ();
}

// The same as StatedErrorsTellTheTruth for points that stop by themselves, each when it meets the target.
TEST(RenderingTest, TargetErrorIsMetWithoutBias) {
  const auto scene = SquareRoom({.reflectance = {0.6}, .radiance = {1}}, 4).Build();
  HonestErrors errors;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    Settings settings;
    settings.seed = seed;
    settings.target_error = 0.02;
    const Ended ended = Render(scene, settings);
    EXPECT_EQ(ended.reason, EndReason::kTargetReached);
    for (const ProbeField& probe : ended.field->probes) {
      double mean = 0;
      for (const double e : probe.irradiance) mean += e / static_cast<double>(probe.irradiance.size());
      for (std::size_t i = 0; i < probe.irradiance.size(); ++i) {
        EXPECT_LE(probe.standard_error[i], 0.02 * std::max(probe.irradiance[i], 0.01 * mean));
        EXPECT_GE(probe.samples[i], 64);
        errors.Add(probe.irradiance[i], 5, probe.standard_error[i]);
      }
    }
  }
  EXPECT_TRUE(errors.Unbiased()) << errors.MeanZ();
}

TEST(RenderingTest, SamplesLimitATargetError) {
  const auto scene = SquareRoom({.reflectance = {0.6}, .radiance = {1}}, 1).Build();
  Settings settings = Sampled(200);
  settings.target_error = 1e-6;
  const Ended ended = Render(scene, settings);
  EXPECT_EQ(ended.reason, EndReason::kSamplesDone);
  EXPECT_EQ(ended.field->probes[0].samples[0], 208);
}

// Rare and bright: only paths through a slit reach the lit chamber. The mean over many seeds is the truth, as a long
// rendering knows it.
TEST(RenderingTest, StoppingAtATargetDoesNotBiasRareBrightLight) {
  SceneMaker maker;
  maker.Polyline("chambers", {{0, 0}, {4, 0}, {4, 1}, {0, 1}}, true, {.reflectance = {0.7}});
  maker.Segment("lower wall", {2, 0}, {2, 0.46}, {.reflectance = {0.3}});
  maker.Segment("upper wall", {2, 0.54}, {2, 1}, {.reflectance = {0.3}});
  maker.Segment("lamp", {3.9, 0.9}, {3.7, 0.9}, {.radiance = {50}});
  maker.PointProbe({0.7, 0.05}, {0, 1});
  const auto scene = maker.Build();
  const Ended truth = Render(scene, Sampled(1 << 17, 1000));
  double sum = 0;
  double squares = 0;
  constexpr int kRuns = 100;
  const double mean = truth.field->probes[0].irradiance[0];
  for (std::uint32_t seed = 0; seed < kRuns; ++seed) {
    Settings settings;
    settings.seed = seed;
    settings.target_error = 0.3;
    const double difference = Render(scene, settings).field->probes[0].irradiance[0] - mean;
    sum += difference;
    squares += difference * difference;
  }
  const double variance = squares + kRuns * kRuns * std::pow(truth.field->probes[0].standard_error[0], 2);
  EXPECT_LT(std::abs(sum), 5 * std::sqrt(variance)) << sum / kRuns << " of " << mean;
}

TEST(RenderingTest, EverySkipLeavesTheSameBits) {
  struct Case {
    std::string name;
    std::shared_ptr<const Scene> scene;
    Settings settings;
    const char* skip;
  };
  Settings target = Sampled(4096);
  target.target_error = 0.05;
  Settings direct = Sampled(128);
  direct.max_bounces = 0;
  Settings exact;
  exact.max_bounces = 0;
  Settings exact_value = exact;
  exact_value.derivatives = Derivatives::kNone;
  SceneMaker dark;
  dark.Segment("floor", {0, 0}, {1, 0}, {.reflectance = {0.5}}).Probe("floor", 3);
  SceneMaker black = UnitLight();
  black.Segment("blocker", {0.5, 0.5}, {1.2, 0.5}).Probe("floor", 5);
  SceneMaker partly_black = black;
  partly_black.Segment("wall", {1.5, 0}, {1.5, 1}, {.reflectance = {0.8}});
  SceneMaker turned = black;
  turned.Segment("turned", {0, 2}, {1, 2}, {.radiance = {1}}).Segment("below", {0, -1}, {1, -1}, {.radiance = {2}});
  SceneMaker grey = FurnishedRoom(true, 3);
  SceneMaker grey3 = UnitLight();
  grey3.Segment("wall", {1.5, 0}, {1.5, 1}, {.reflectance = {0.5, 0.5, 0.5}}).Probe("floor", 3);
  SceneMaker convex = SquareRoom({.reflectance = {0.5}, .radiance = {1}}, 3);
  SceneMaker facing = UnitLight();
  facing.Probe("floor", 5).Probe("light", 2);
  const std::vector<Case> cases = {
      {"dark", dark.Build(), Sampled(64), skip::kEmission},
      {"dark exact", dark.Build(), exact, skip::kEmission},
      {"grey", grey.Build(), Sampled(64), skip::kColour},
      {"grey with 3 channels", grey3.Build(), Sampled(64), skip::kColour},
      {"grey exact", grey.Build(), exact, skip::kColour},
      {"convex", convex.Build(), Sampled(64), skip::kVisibility},
      {"facing", facing.Build(), direct, skip::kVisibility},
      {"facing exact", facing.Build(), exact, skip::kVisibility},
      {"no derivatives", grey.Build(), exact_value, skip::kDerivatives},
      {"black", black.Build(), Sampled(64), skip::kBounces},
      {"black paths", black.Build(), Sampled(64), skip::kBlackPaths},
      {"partly black", partly_black.Build(), Sampled(64), skip::kBlackPaths},
      {"turned away", turned.Build(), direct, skip::kUnseenEmitters},
      {"converged", convex.Build(), target, skip::kConvergedPoints},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const Plan plan = PlanFor(*c.scene, c.settings);
    EXPECT_TRUE(plan.Takes(c.skip));
    Settings disabled = c.settings;
    disabled.no_skip = {c.skip};
    EXPECT_TRUE(PlanFor(*c.scene, disabled).Disables(c.skip));
    const Ended with = Render(c.scene, c.settings);
    const Ended without = Render(c.scene, disabled);
    ASSERT_EQ(with.field->probes.size(), without.field->probes.size());
    for (std::size_t p = 0; p < with.field->probes.size(); ++p) {
      EXPECT_EQ(with.field->probes[p].irradiance, without.field->probes[p].irradiance);
      EXPECT_EQ(with.field->probes[p].gradient, without.field->probes[p].gradient);
      EXPECT_EQ(with.field->probes[p].samples, without.field->probes[p].samples);
      EXPECT_EQ(with.field->probes[p].standard_error, without.field->probes[p].standard_error);
    }
    if (c.skip == skip::kConvergedPoints || c.skip == skip::kVisibility || c.skip == skip::kBounces) {
      EXPECT_LE(with.field->rays, without.field->rays);
    }
  }
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
