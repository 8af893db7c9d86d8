// SPDX-License-Identifier: Apache-2.0
// The method `reference`: what it agrees with, how it ends, what it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/execution/thread_pool.h"
#include "core/render/plan.h"
#include "core/render/rendering.h"
#include "tests/support/transport/honest_errors.h"
#include "tests/support/transport/mistakes.h"
#include "tests/support/transport/render.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Settings Reference(double target) {
  Settings settings;
  settings.method = Method::kReference;
  settings.target_error = target;
  return settings;
}

// Everything at once: a room that is open to the sky, lamps, blockers, lights without a surface, in colour.
SceneMaker OpenRoom() {
  SceneMaker maker;
  maker.Segment("floor", {0, 0}, {4, 0}, {.reflectance = {0.5, 0.6, 0.7}});
  maker.Segment("left", {0, 3}, {0, 0}, {.reflectance = {0.2, 0.8, 0.3}});
  maker.Segment("lamp", {2.5, 2.9}, {1.5, 2.9}, {.reflectance = {0.3}, .radiance = {5, 4, 3}, .two_sided = true});
  maker.Arc("disc", {{2.8, 0.8}, 0.4, 0, -6.283185307179586}, {.reflectance = {0.6}});
  maker.Segment("shelf", {1, 1.5}, {2, 1.6}, {.reflectance = {0.9, 0.4, 0.4}});
  maker.Environment({0.5, 0.6, 0.9});
  maker.Light(PointLightDescription{{1.2, 0.3}, {1, 2, 3}});
  maker.Light(SpotLightDescription{{3.5, 2.5}, {-1, -1}, {2, 1, 3}, 0.1, 0.7});
  maker.Light(DirectionalLightDescription{{1, -2}, {1, 1, 1}});
  for (const char* curve : {"floor", "left", "disc", "shelf"}) maker.Probe(curve, 16);
  return maker;
}

TEST(ReferenceRenderingTest, PathTracingAgrees) {
  for (const bool open : {false, true}) {
    for (const auto bounces :
         {std::optional<std::uint32_t>(), std::optional<std::uint32_t>(1), std::optional<std::uint32_t>(3)}) {
      const auto scene = open ? OpenRoom().Build() : FurnishedRoom(false, 16).Build();
      Settings settings = Reference(1e-4);
      settings.max_bounces = bounces;
      const Ended reference = Render(scene, settings);
      EXPECT_EQ(reference.reason, EndReason::kTargetReached);
      Settings sampled = Sampled(1024, 7);
      sampled.max_bounces = bounces;
      const Ended traced = Render(scene, sampled);
      HonestErrors errors, wrong;
      for (std::size_t p = 0; p < reference.field->probes.size(); ++p) {
        const ProbeField &r = reference.field->probes[p], &t = traced.field->probes[p];
        // The channels of a point share their paths.
        for (std::size_t i = 1; i < r.irradiance.size(); i += 3) {
          errors.Add(t.irradiance[i], r.irradiance[i], t.standard_error[i]);
          wrong.Add(t.irradiance[i], 1.02 * r.irradiance[i], t.standard_error[i]);
        }
      }
      EXPECT_EQ(errors.count(), 64u);
      EXPECT_TRUE(errors.Unbiased()) << errors.MeanZ() << ' ' << open;
      EXPECT_LT(errors.MeanSquareZ(), 2) << open;
      EXPECT_FALSE(wrong.Unbiased() && wrong.MeanSquareZ() < 2);
    }
  }
}

TEST(ReferenceRenderingTest, WithoutBouncesItIsExact) {
  const auto scene = OpenRoom().Build();
  Settings settings = Reference(1e-6);
  settings.max_bounces = 0;
  const Ended reference = Render(scene, settings);
  settings = {};
  settings.method = Method::kExact;
  settings.max_bounces = 0;
  const Ended exact = Render(scene, settings);
  for (std::size_t p = 0; p < exact.field->probes.size(); ++p) {
    EXPECT_EQ(reference.field->probes[p].irradiance, exact.field->probes[p].irradiance);
    EXPECT_EQ(reference.field->probes[p].gradient, exact.field->probes[p].gradient);
    EXPECT_EQ(reference.field->probes[p].hessian, exact.field->probes[p].hessian);
  }
}

// A grey world computes one channel, in colour or not.
TEST(ReferenceRenderingTest, SkipsColourWhereThereIsNone) {
  Settings settings = Reference(1e-3);
  const auto scene = FurnishedRoom(true, 4).Build();
  const Ended grey = Render(scene, settings);
  settings.no_skip = {"colour"};
  EXPECT_EQ(HashOf(*Render(scene, settings).field), HashOf(*grey.field));
}

TEST(ReferenceRenderingTest, BitsDependOnNothingButTheRoundsDone) {
  const auto scene = FurnishedRoom(false, 5).Build();
  const Ended whole = Render(scene, Reference(1e-3));
  for (const int threads : {1, 2, 5}) {
    for (const Clock::Duration budget : {Clock::Duration(0), kForever}) {
      const Ended other = Render(scene, Reference(1e-3), threads, budget);
      EXPECT_EQ(HashOf(*other.field), HashOf(*whole.field)) << threads;
    }
  }
}

TEST(ReferenceRenderingTest, GoesOnAfterItWasCancelled) {
  const auto scene = FurnishedRoom(true, 5).Build();
  const auto rendering = StartRendering(scene, PlanFor(*scene, Reference(1e-3)));
  InlineExecutor executor;
  const SteadyClock clock;
  Cancellation cancelled;
  cancelled.Cancel();
  const Cancellation never;
  for (int i = 0; i < 2000 && !rendering->done(); ++i) {
    rendering->Advance(executor, cancelled, clock, kForever);
    EXPECT_FALSE(rendering->done());
    rendering->Advance(executor, never, clock, Clock::Duration(0));
  }
  ASSERT_TRUE(rendering->done());
  EXPECT_EQ(HashOf(*rendering->Snapshot()), HashOf(*Render(scene, Reference(1e-3)).field));
}

// Cancels within its n-th loop.
class CancellingExecutor final : public Executor {
 public:
  CancellingExecutor(int loops, Cancellation& cancellation) : left_(loops), cancellation_(cancellation) {}
  int threads() const override { return 1; }
  void ParallelFor(std::size_t count, int /*max_threads*/, const std::function<void(std::size_t)>& work) override {
    if (cancellation_.cancelled()) ++loops_after_;
    for (std::size_t i = 0; i < count; ++i) work(i);
    if (--left_ == 0) cancellation_.Cancel();
  }
  int loops_after() const { return loops_after_; }

 private:
  int left_;
  int loops_after_ = 0;
  Cancellation& cancellation_;
};

// Between two steps of the solver too, which may be many.
TEST(ReferenceRenderingTest, WorksNoMoreOnceItIsCancelled) {
  const auto scene = FurnishedRoom(true, 5).Build();
  const auto rendering = StartRendering(scene, PlanFor(*scene, Reference(1e-3)));
  const SteadyClock clock;
  int cancelled_in = 0;
  for (int i = 0; !rendering->done() && i < 2000; ++i) {
    Cancellation cancellation;
    CancellingExecutor executor(1 + i % 3, cancellation);
    rendering->Advance(executor, cancellation, clock, kForever);
    EXPECT_EQ(executor.loops_after(), 0);
    cancelled_in += cancellation.cancelled() ? 1 : 0;
  }
  ASSERT_TRUE(rendering->done());
  EXPECT_GT(cancelled_in, 50);
  EXPECT_EQ(HashOf(*rendering->Snapshot()), HashOf(*Render(scene, Reference(1e-3)).field));
}

TEST(ReferenceRenderingTest, StatesABoundForEachValue) {
  const auto scene = FurnishedRoom(false, 5).Build();
  const Ended ended = Render(scene, Reference(1e-3));
  double largest = 0;
  for (const ProbeField& probe : ended.field->probes) {
    ASSERT_EQ(probe.irradiance_error.size(), 15u);
    EXPECT_TRUE(probe.standard_error.empty());
    for (const double bound : probe.irradiance_error) largest = std::max(largest, bound);
    for (const double bound : probe.gradient_error) EXPECT_GT(bound, 0);
    for (const double bound : probe.hessian_error) EXPECT_GT(bound, 0);
  }
  EXPECT_EQ(ended.field->error_bound, largest);
}

// Each time that it is read it is so much later.
class SteppingClock final : public Clock {
 public:
  explicit SteppingClock(Duration step) : step_(step) {}
  Time Now() const override { return Time(++reads_ * step_); }

 private:
  Duration step_;
  mutable int reads_ = 0;
};

// In the midst of the first round too: then there is direct light, as far as there was time for it, and a bound on what
// is reflected.
TEST(ReferenceRenderingTest, EndsAtTheTimeLimit) {
  const auto scene = FurnishedRoom(true, 5).Build();
  const Ended truth = Render(scene, Reference(1e-4));
  Settings settings = Reference(1e-9);
  settings.time_limit = 1;
  const Cancellation never;
  for (const int reads : {1, 3, 10, 40}) {
    const auto rendering = StartRendering(scene, PlanFor(*scene, settings));
    InlineExecutor executor;
    const SteppingClock clock(std::chrono::duration_cast<Clock::Duration>(std::chrono::duration<double>(1.0 / reads)));
    int slices = 0;
    while (!rendering->done()) rendering->Advance(executor, never, clock, Clock::Duration(0)), ++slices;
    EXPECT_LE(slices, reads);
    EXPECT_EQ(rendering->end_reason(), EndReason::kTimeLimit);
    const auto field = rendering->Snapshot();
    for (std::size_t p = 0; p < field->probes.size(); ++p) {
      const ProbeField &probe = field->probes[p], &right = truth.field->probes[p];
      ASSERT_EQ(probe.irradiance.size(), right.irradiance.size());
      for (std::size_t i = 0; i < right.irradiance.size(); ++i) {
        const double error = std::abs(probe.irradiance[i] - right.irradiance[i]);
        EXPECT_LE(error, probe.irradiance_error[i] + right.irradiance_error[i]) << reads;
        EXPECT_GT(probe.irradiance_error[i], 0.1 * right.irradiance[i]) << reads;
      }
    }
  }
}

// Over mirrors and through glass a round is long.
TEST(ReferenceRenderingTest, EndsAtTheTimeLimitInTheFirstRoundOverMirrors) {
  SceneMaker maker = SquareRoom({.reflectance = {0.5}, .radiance = {1}}, 2);
  maker.Segment("first mirror", {-0.5, -0.9}, {-0.5, 0.9}, {.material = MirrorDescription{{0.99}}});
  maker.Segment("second mirror", {0.5, 0.9}, {0.5, -0.9}, {.material = MirrorDescription{{0.99}}});
  maker.Polyline("prism", {{-0.3, -0.6}, {0.4, -0.5}, {0.1, 0.1}}, true, {.material = DielectricDescription{1.5}});
  const auto scene = maker.Build();
  Settings settings = Reference(1e-9);
  settings.time_limit = 1e-9;
  const Ended ended = Render(scene, settings);
  EXPECT_EQ(ended.reason, EndReason::kTimeLimit);
  // All that the walls emit and reflect, times the index of the glass.
  EXPECT_GT(*ended.field->error_bound, 4);
  EXPECT_LT(*ended.field->error_bound, 10);
}

TEST(ReferenceRenderingTest, TheDarkNeedsNoWork) {
  const Ended ended = Render(SquareRoom({.reflectance = {0.5}}, 2).Build(), Reference(1e-6));
  EXPECT_EQ(ended.field->probes[0].irradiance, std::vector<double>(2, 0.0));
  EXPECT_EQ(ended.field->error_bound, 0);
}

TEST(ReferenceRenderingTest, OverMirrorsThereAreDerivativesWhereTheyAreAskedFor) {
  SceneMaker maker = SquareRoom({.reflectance = {0.5}, .radiance = {1}}, 2);
  maker.Segment("mirror", {0, 0}, {0.5, 0}, {.material = MirrorDescription{{0.9}}});
  Settings settings;
  settings.method = Method::kReference;
  const Ended all = Render(maker.Build(), settings);
  EXPECT_GT(all.field->probes[0].irradiance[0], 0);
  EXPECT_TRUE(all.field->probes[0].gradient.empty());
  settings.derivatives = Derivatives::kHessian;
  const Ended with = Render(maker.Build(), settings);
  EXPECT_FALSE(with.field->probes[0].gradient.empty());
  EXPECT_FALSE(with.field->probes[0].hessian.empty());
  settings.derivatives.reset();
  settings.max_bounces = 0;
  EXPECT_FALSE(Render(maker.Build(), settings).field->probes[0].gradient.empty());
}

TEST(ReferenceRenderingTest, RefusesWhatItCannotDoOverMirrors) {
  SceneMaker maker = SquareRoom({.reflectance = {0.5}, .radiance = {1}}, 1);
  maker.Segment("glass", {0, 0}, {0.5, 0}, {.material = MirrorDescription{{0.9}}});
  EXPECT_THAT(Mistakes(*maker.Build(), Reference(1e-3)), ElementsAre());
  Settings more = Reference(1e-3);
  more.max_bounces = 3;
  EXPECT_THAT(Mistakes(*maker.Build(), more),
              ElementsAre(HasSubstr("settings.maxBounces: is 3, but over mirrors, glass and phong lobes reference")));
  maker.Bezier("bend", {{0, 0.2}, {0.1, 0.3}, {0.2, 0.3}, {0.3, 0.2}});
  EXPECT_THAT(Mistakes(*maker.Build(), Reference(1e-3)), ElementsAre());
  maker.Light(PointLightDescription{.position = {0, 0.5}, .power = {1}});
  EXPECT_THAT(Mistakes(*maker.Build(), Reference(1e-3)),
              ElementsAre(HasSubstr("settings.method: reference leaves out what plane.lights send over mirrors")));
}

// In colour, with what has and what has not a surface.
TEST(ReferenceRenderingTest, PhongLobesReflectInColour) {
  SceneMaker maker = SquareRoom({.reflectance = {0.5, 0.4, 0.3}}, 1);
  maker.Segment("lamp", {0.4, 0.9}, {-0.4, 0.9}, {.radiance = {1}});
  maker.Segment("gloss", {-0.5, -0.7}, {0.5, -0.7}, {.material = PhongDescription{{0.9, 0.6, 0.3}, 8}});
  maker.Light(PointLightDescription{.position = {0, 0.5}, .power = {1}}).Probe("gloss", 2);
  const auto scene = maker.Build();
  const Ended ended = Render(scene, Reference(3e-3));
  EXPECT_EQ(ended.reason, EndReason::kTargetReached);
  const ProbeField& walls = ended.field->probes[1];
  EXPECT_TRUE(walls.gradient.empty());
  EXPECT_GT(walls.irradiance[0], 1.01 * walls.irradiance[1]);
  EXPECT_GT(walls.irradiance[1], 1.01 * walls.irradiance[2]);
  for (std::size_t i = 0; i < walls.irradiance.size(); ++i) {
    EXPECT_GT(walls.irradiance_error[i], 0);
    EXPECT_LE(walls.irradiance_error[i], 3e-3 * walls.irradiance[i]);
  }
}

// Before the first round is done there are bounds on all light, whatever they are.
TEST(ReferenceRenderingTest, EndsAtTheTimeLimitInTheFirstRoundWithPhongLobes) {
  SceneMaker maker = SquareRoom({.reflectance = {0.5}, .radiance = {1}}, 2);
  maker.Segment("gloss", {-0.5, 0}, {0.5, 0}, {.material = PhongDescription{{0.5}, 8}});
  Settings settings = Reference(1e-9);
  settings.time_limit = 1e-9;
  const Ended ended = Render(maker.Build(), settings);
  EXPECT_EQ(ended.reason, EndReason::kTimeLimit);
  // What is emitted and reflected for ever by half: radiance 2 from the half circle.
  EXPECT_GE(*ended.field->error_bound, 2);
  EXPECT_LE(*ended.field->error_bound, 4 * (1 + 1e-9));
}

TEST(ReferenceRenderingTest, RefusesWhatItCannotDoWithPhongLobes) {
  SceneMaker maker = SquareRoom({.reflectance = {0.5}, .radiance = {1}}, 1);
  maker.Segment("gloss", {0, 0}, {0.5, 0}, {.material = PhongDescription{{0.9}, 5}});
  maker.Light(PointLightDescription{.position = {0, 0.5}, .power = {1}});
  EXPECT_THAT(Mistakes(*maker.Build(), Reference(1e-3)), ElementsAre());
  Settings more = Reference(1e-3);
  more.derivatives = Derivatives::kGradient;
  more.max_bounces = 3;
  EXPECT_THAT(Mistakes(*maker.Build(), more),
              ElementsAre(HasSubstr("settings.derivatives: reference gives none of light that phong lobes reflect"),
                          HasSubstr("settings.maxBounces: is 3, but over mirrors, glass and phong lobes")));
  maker.Segment("mirror", {0, -0.5}, {0.5, -0.5}, {.material = MirrorDescription{{0.9}}});
  maker.Bezier("bend", {{0, 0.2}, {0.1, 0.3}, {0.2, 0.3}, {0.3, 0.2}});
  EXPECT_THAT(
      Mistakes(*maker.Build(), Reference(1e-3)),
      ElementsAre(HasSubstr("\"gloss\" is one, where nothing is a mirror or glass, and curve \"mirror\" is: use"),
                  HasSubstr("settings.method: reference does scenes with Bézier curves where nothing is")));
}

TEST(ReferenceRenderingTest, RefusesWhatItCannotDo) {
  SceneMaker maker = SquareRoom({.reflectance = {0.5}, .radiance = {1}}, 1);
  maker.Segment("gloss", {0, 0}, {0.5, 0}, {.material = ConductorDescription{{0.9}, 0.5}});
  const auto scene = maker.Build();
  EXPECT_THAT(Mistakes(*scene, Reference(1e-3)),
              ElementsAre("settings.method: reference does lambertian, phong, mirror and dielectric materials, and "
                          "curve \"gloss\" has another: use path-tracing"));
  Settings direct = Reference(1e-3);
  direct.max_bounces = 0;
  EXPECT_THAT(Mistakes(*scene, direct), ElementsAre());
  Settings samples = Reference(1e-3);
  samples.samples = 16;
  samples.seed = 3;
  EXPECT_THAT(Mistakes(*FurnishedRoom(true, 1).Build(), samples),
              ElementsAre(HasSubstr("settings.samples: does not apply"), HasSubstr("settings.seed: does not apply")));
  SceneMaker many = SquareRoom({.reflectance = {0.5}, .radiance = {1}}, 1);
  for (int i = 0; i < 2045; ++i) {
    const double x = -0.9 + 1.8 * i / 2045;
    many.Segment("blade" + std::to_string(i), {x, -0.5}, {x, 0.5});
  }
  EXPECT_THAT(
      Mistakes(*many.Build(), Reference(1e-3)),
      ElementsAre("settings.method: reference does scenes of up to 2048 straight and arced pieces, and this one "
                  "has 2049: use path-tracing"));
  EXPECT_THAT(Mistakes(*many.Build(), direct), ElementsAre());
  const auto mirror_room = SquareRoom({.reflectance = {1}, .radiance = {1}}, 1).Build();
  EXPECT_THAT(Mistakes(*mirror_room, Reference(1e-3)), ElementsAre(HasSubstr("light never fades")));
}

// Of direct light there is no limit to curves, nor to their materials, and no work that grows by pairs of them.
TEST(ReferenceRenderingTest, DirectLightIsThatOfTheExactMethod) {
  for (const bool black : {false, true}) {
    SceneMaker maker;
    const Look wall{.reflectance = {black ? 0.0 : 0.5}};
    maker.Segment("floor", {-1, 0}, {1, 0}, wall);
    maker.Segment("lamp", {0.5, 2}, {-0.5, 2}, {.reflectance = wall.reflectance, .radiance = {5}});
    for (int i = 0; i < 3000; ++i) {
      const double x = -0.9 + 1.8 * i / 3000;
      maker.Segment("blade" + std::to_string(i), {x, 0.9}, {x + 3e-4, 0.9}, wall);
    }
    if (!black) maker.Segment("mirror", {1, 0}, {1, 2}, {.material = MirrorDescription{{0.9}}});
    maker.Probe("floor", 4);
    const auto scene = maker.Build();
    Settings settings = Reference(1e-6);
    if (!black) settings.max_bounces = 0;
    const Ended reference = Render(scene, settings);
    settings.method = Method::kExact;
    settings.target_error.reset();
    const Ended exact = Render(scene, settings);
    EXPECT_EQ(reference.reason, EndReason::kTargetReached);
    EXPECT_GT(exact.field->probes[0].irradiance[0], 0);
    for (std::size_t i = 0; i < 4; ++i) {
      const double error = reference.field->probes[0].irradiance_error[i];
      EXPECT_LT(error, 1e-9);
      // Both have such an error.
      EXPECT_NEAR(reference.field->probes[0].irradiance[i], exact.field->probes[0].irradiance[i], 2 * error);
    }
  }
}

TEST(ReferenceRenderingTest, ThePlanSaysWhatComes) {
  Settings settings;
  settings.method = Method::kReference;
  const Plan plan = PlanFor(*FurnishedRoom(true, 4).Build(), settings);
  EXPECT_EQ(plan.settings.target_error, 1e-6);
  EXPECT_EQ(plan.settings.derivatives, Derivatives::kHessian);
  EXPECT_EQ(plan.summary,
            "Reference of all bounces with gradient and Hessian at 16 points, until the error is 0.0001 %.");
}

}  // namespace
}  // namespace flatlight
