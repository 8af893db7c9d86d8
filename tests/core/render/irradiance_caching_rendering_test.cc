// SPDX-License-Identifier: Apache-2.0
// The method `irradiance-caching`: what it agrees with, how it spends records, what it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "core/render/plan.h"
#include "tests/core/render/caching_support.h"
#include "tests/support/transport/mistakes.h"
#include "tests/support/transport/render.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

TEST(IrradianceCachingRenderingTest, AgreesWithTheReference) {
  const auto scene = DividedRoom().Build();
  for (const std::optional<std::uint32_t> bounces : {std::optional<std::uint32_t>(1), std::optional<std::uint32_t>()}) {
    Settings settings = Caching();
    settings.max_bounces = bounces;
    for (const double tolerance : {0.03, 0.003}) {
      settings.tolerance = tolerance;
      const Difference difference = FromReference(scene, settings);
      EXPECT_LT(difference.rms, 1.5 * tolerance);
      EXPECT_LT(difference.largest, 15 * tolerance);
    }
  }
}

// A floor below a lamp, all of which reflects; walls beside it, of which one shines dimly; a plate between.
SceneMaker ReflectingFloor(bool walls, bool blocker) {
  const Look look = {.reflectance = {0.5}};
  SceneMaker maker;
  maker.Segment("floor", {0, 0}, {1, 0}, look).Probe("floor", 257);
  maker.Segment("lamp", {1, 1}, {0, 1}, {.reflectance = {0.5}, .radiance = {1}});
  if (walls) {
    maker.Segment("left", {0, 1}, {0, 0}, look);
    maker.Segment("right", {1, 0}, {1, 1}, {.reflectance = {0.5}, .radiance = {0.1}});
  }
  if (blocker) maker.Segment("blocker", {0.45, 0.5}, {0.7, 0.5}, look);
  return maker;
}

TEST(IrradianceCachingRenderingTest, EventsAndSecondOrderAreFarAheadAlsoWithSeveralBounces) {
  for (const auto& [walls, blocker] : {std::pair(false, false), {false, true}, {true, false}, {true, true}}) {
    const auto scene = ReflectingFloor(walls, blocker).Build();
    for (const std::uint32_t records : {8u, 10u, 16u}) {
      Settings settings = Caching();
      settings.max_records = records;
      const double events = FromReference(scene, settings).rms;
      settings.error_control = ErrorControl::kSplitSphere;
      settings.extrapolation = 1;
      // Eight are few for two corners and a blocker's edges.
      const double times = walls && blocker && records == 8 ? 10 : 15;
      EXPECT_GT(FromReference(scene, settings).rms, times * events) << walls << blocker << ' ' << records;
    }
  }
}

// A receiver in a bend sees it right beside itself, where the direction to what it sees is lost to rounding.
TEST(IrradianceCachingRenderingTest, AgreesWithTheReferenceInARoundRoom) {
  SceneMaker maker;
  maker.Arc("ring", {{0, 0}, 1, 0, 6.283185307179586}, {.reflectance = {0.6}});
  maker.Arc("sun", {{-0.25, 0.1}, 0.15, 0, -6.283185307179586}, {.reflectance = {0.1}, .radiance = {3}});
  maker.Arc("moon", {{0.4, -0.2}, 0.25, 1, -2.5}, {.reflectance = {0.6}});
  const auto scene = maker.Probe("ring", 300).Build();
  Settings settings = Caching();
  settings.tolerance = 0.003;
  const Difference difference = FromReference(scene, settings);
  EXPECT_LT(difference.rms, settings.tolerance);
  EXPECT_LT(difference.largest, 5 * settings.tolerance.value());
}

TEST(IrradianceCachingRenderingTest, EstimatesHold) {
  SceneMaker round;
  round.Arc("ring", {{0, 0}, 1, 0, 6.283185307179586}, {.reflectance = {0.6}});
  round.Arc("sun", {{-0.25, 0.1}, 0.15, 0, -6.283185307179586}, {.reflectance = {0.1}, .radiance = {3}});
  round.Arc("moon", {{0.4, -0.2}, 0.25, 1, -2.5}, {.reflectance = {0.6}}).Probe("ring", 300);
  for (const auto& scene : {DividedRoom().Build(), round.Build(), ReflectingFloor(true, true).Build()}) {
    const auto expected = ReferenceOf(scene);
    for (const double tolerance : {0.03, 0.003}) {
      for (const std::uint32_t degree : {1u, 2u}) {
        Settings settings = Caching();
        settings.tolerance = tolerance;
        settings.extrapolation = degree;
        const auto field = Render(scene, settings).field;
        EXPECT_LT(ShareAboveEstimate(*field, *expected, 1), 0.07) << tolerance << ' ' << degree;
        EXPECT_LT(ShareAboveEstimate(*field, *expected, 2), 0.02) << tolerance << ' ' << degree;
      }
    }
  }
}

TEST(IrradianceCachingRenderingTest, RaysTellWhatPanelsTell) {
  const auto scene = DividedRoom().Build();
  Settings settings = Caching();
  settings.max_bounces = 1;
  settings.samples = 4096;
  settings.tolerance = 0.03;
  const Difference difference = FromReference(scene, settings);
  EXPECT_LT(difference.rms, 0.02);
  EXPECT_LT(difference.largest, 0.3);
}

// The divider parts light from dark: no record of one side counts on the other.
TEST(IrradianceCachingRenderingTest, NothingLeaksThroughAWall) {
  SceneMaker maker;
  maker.Segment("floor", {-1, 0}, {1, 0}).Probe("floor", 100);
  maker.Segment("wall", {0, 0}, {0, 3});
  maker.Segment("lamp", {-0.3, 1}, {-0.9, 1}, {.radiance = {1}});
  for (int point = 0; point < 20; ++point) maker.PointProbe({-1 + 0.1 * point + 0.05, 0.1}, {0, 1});
  const auto scene = maker.Build();
  for (int control = 0; control <= static_cast<int>(ErrorControl::kVisibilityEvents); ++control) {
    Settings settings = Caching();
    settings.error_control = static_cast<ErrorControl>(control);
    settings.max_records = 12;
    const auto field = Render(scene, settings).field;
    for (std::size_t p = 0; p < field->probes.size(); ++p) {
      const Probe& probe = scene->probes()[p];
      for (std::size_t i = 0; i < probe.receivers.size(); ++i) {
        const double x = scene->ToWorld(probe.receivers[i].position).x;
        if (x > 0) {
          EXPECT_EQ(field->probes[p].irradiance[i], 0) << control << ' ' << x;
        } else {
          EXPECT_GT(field->probes[p].irradiance[i], 0) << control << ' ' << x;
        }
      }
    }
  }
}

TEST(IrradianceCachingRenderingTest, ThreadsAndSlicesLeaveNoTrace) {
  const auto scene = DividedRoom().Build();
  for (const Gather gather : {Gather::kReference, Gather::kRayTracing, Gather::kPhotonMap}) {
    Settings settings = Caching();
    settings.max_bounces = 1;
    settings.gather = gather;
    if (gather != Gather::kReference) settings.samples = 64;
    if (gather == Gather::kPhotonMap) settings.photons = 5000;
    settings.tolerance = 0.05;
    const Ended once = Render(scene, settings);
    for (const int threads : {2, 7}) {
      const Ended again = Render(scene, settings, threads, std::chrono::microseconds(200));
      EXPECT_EQ(HashOf(*again.field), HashOf(*once.field));
      ASSERT_EQ(again.field->records.size(), once.field->records.size());
      for (std::size_t i = 0; i < once.field->records.size(); ++i) {
        EXPECT_EQ(again.field->records[i].position, once.field->records[i].position);
        EXPECT_EQ(again.field->records[i].irradiance, once.field->records[i].irradiance);
        EXPECT_EQ(again.field->records[i].left_radius, once.field->records[i].left_radius);
      }
    }
  }
}

TEST(IrradianceCachingRenderingTest, RecordsAreToldInWorldUnits) {
  SceneMaker maker;
  maker.Segment("floor", {10, 10}, {10 + 8e3, 10}).Probe("floor", 50);
  maker.Segment("lamp", {10 + 5e3, 10 + 4e3}, {10 + 3e3, 10 + 4e3}, {.radiance = {100}});
  Settings settings = Caching();
  settings.max_records = 6;
  const Ended ended = Render(maker.Build(), settings);
  EXPECT_EQ(ended.reason, EndReason::kSamplesDone);
  ASSERT_EQ(ended.field->records.size(), 6u);
  Settings truth;
  truth.method = Method::kExact;
  for (const RecordField& record : ended.field->records) {
    EXPECT_EQ(record.curve, "floor");
    EXPECT_EQ(record.side, Side::kFront);
    SceneMaker there = maker;
    there.PointProbe(record.position, record.normal);
    const ProbeField exact = Render(there.Build(), truth).field->probes.back();
    ASSERT_EQ(record.hessian.size(), 1u);
    EXPECT_NEAR(record.irradiance[0], exact.irradiance[0], 1e-9 * exact.irradiance[0]);
    EXPECT_NEAR(record.gradient[0], exact.gradient[0], 1e-9 * std::abs(exact.gradient[0]) + 1e-15);
    EXPECT_NEAR(record.hessian[0], exact.hessian[0], 1e-9 * std::abs(exact.hessian[0]) + 1e-18);
    EXPECT_GT(record.left_radius + record.right_radius, 100);
  }
}

TEST(IrradianceCachingRenderingTest, DarkScenesAreDark) {
  SceneMaker maker = SquareRoom({.reflectance = {0.5}}, 10);
  const Ended ended = Render(maker.Build(), Caching());
  for (const ProbeField& probe : ended.field->probes)
    for (const double value : probe.irradiance) EXPECT_EQ(value, 0);
  EXPECT_TRUE(ended.field->records.empty());
}

Ended RenderKnowing(const std::shared_ptr<const Scene>& scene, const Settings& settings, const Field& earlier,
                    int threads = 1) {
  Plan plan = PlanFor(*scene, settings);
  plan.known_records = std::make_shared<const std::vector<RecordField>>(earlier.records);
  const std::unique_ptr<Rendering> rendering = StartRendering(scene, plan);
  ThreadPool pool(threads);
  while (!rendering->done()) rendering->Advance(pool, Cancellation(), SteadyClock(), std::chrono::microseconds(200));
  return {rendering->Snapshot(), rendering->end_reason()};
}

TEST(IrradianceCachingRenderingTest, TheSameJobNeedsNoMoreThanItsOwnRecords) {
  const auto scene = DividedRoom().Build();
  for (const bool rays : {false, true}) {
    for (const ErrorControl control : {ErrorControl::kVisibilityEvents, ErrorControl::kSplitSphere}) {
      Settings settings = Caching();
      settings.max_bounces = 1;
      settings.error_control = control;
      settings.tolerance = 0.1;
      if (rays) settings.samples = 64;
      const Ended once = Render(scene, settings);
      const Ended again = RenderKnowing(scene, settings, *once.field);
      EXPECT_EQ(HashOf(*again.field), HashOf(*once.field));
      EXPECT_EQ(again.field->reused_records, once.field->records.size());
      EXPECT_EQ(again.field->records.size(), once.field->records.size());
      EXPECT_EQ(once.field->reused_records, 0u);
    }
  }
}

TEST(IrradianceCachingRenderingTest, AFinerJobBeginsWithTheRecordsOfACoarserOne) {
  const auto coarse = DividedRoom().Build();
  Settings settings = Caching();
  settings.max_bounces = 1;
  settings.tolerance = 0.05;
  const Ended first = Render(coarse, settings);
  SceneMaker maker = DividedRoom(200);
  maker.PointProbe({0.5, -0.5}, {0, 1});
  const auto fine = maker.Build();
  settings.tolerance = 0.005;
  const Ended alone = Render(fine, settings);
  const Ended knowing = RenderKnowing(fine, settings, *first.field);
  EXPECT_EQ(knowing.field->reused_records, first.field->records.size());
  const std::size_t made = knowing.field->records.size() - knowing.field->reused_records;
  EXPECT_LT(made, alone.field->records.size());
  EXPECT_GT(made, 0u);
  for (const int threads : {2, 5})
    EXPECT_EQ(HashOf(*RenderKnowing(fine, settings, *first.field, threads).field), HashOf(*knowing.field));
  Settings truth;
  truth.method = Method::kReference;
  truth.max_bounces = 1;
  const auto expected = Render(fine, truth).field;
  double squares = 0, mean = 0;
  const std::vector<double>& truths = expected->probes[0].irradiance;
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const double off = knowing.field->probes[0].irradiance[i] - truths[i];
    squares += off * off, mean += truths[i];
  }
  const auto n = static_cast<double>(truths.size());
  EXPECT_LT(std::sqrt(squares / n), 1.5 * settings.tolerance.value() * mean / n);
}

// What is told may be anything: a record that does not lie where it says is of no use.
TEST(IrradianceCachingRenderingTest, RecordsThatLieElsewhereAreLeft) {
  const auto scene = DividedRoom().Build();
  Settings settings = Caching();
  settings.max_bounces = 1;
  settings.max_records = 20;
  const Ended once = Render(scene, settings);
  Field moved = *once.field;
  for (std::size_t i = 0; i < moved.records.size(); ++i) {
    if (i % 3 == 0) moved.records[i].position.x += 0.01;
    if (i % 3 == 1) moved.records[i].normal = -moved.records[i].normal;
    if (i % 3 == 2) moved.records[i].arc_length.reset();
  }
  const Ended again = RenderKnowing(scene, settings, moved);
  EXPECT_EQ(again.field->reused_records, 0u);
  EXPECT_EQ(HashOf(*again.field), HashOf(*once.field));
}

TEST(IrradianceCachingRenderingTest, ReasonsSpeakOfRaysWhereThereAreSome) {
  const auto scene = DividedRoom().Build();
  for (const bool rays : {false, true}) {
    Settings settings = Caching();
    if (rays) settings.samples = 64;
    bool any = false;
    for (const SkipEntry& entry : PlanFor(*scene, settings).skips)
      any = any || entry.reason.find("rays") != std::string::npos;
    EXPECT_EQ(any, rays);
  }
}

TEST(IrradianceCachingRenderingTest, SettingsThatItWouldIgnoreAreMistakes) {
  const auto scene = DividedRoom().Build();
  Settings settings = Caching();
  settings.extrapolation = 3;
  settings.tolerance = 0.1;
  settings.max_records = 0;
  settings.target_error = 0.1;
  settings.time_limit = 1;
  settings.derivatives = Derivatives::kGradient;
  settings.gather = Gather::kReference;
  settings.samples = 16;
  EXPECT_THAT(Mistakes(*scene, settings),
              UnorderedElementsAre(HasSubstr("settings.extrapolation: is 3"), HasSubstr("settings.maxRecords: is 0"),
                                   HasSubstr("settings.maxRecords: is given together"),
                                   HasSubstr("settings.targetError: does not apply"),
                                   HasSubstr("settings.timeLimit: does not apply"),
                                   HasSubstr("settings.derivatives: irradiance-caching gives none"),
                                   HasSubstr("settings.samples: does not apply where records gather from")));
  Settings other;
  other.method = Method::kPathTracing;
  other.error_control = ErrorControl::kSplitSphere;
  other.extrapolation = 1;
  other.tolerance = 0.1;
  other.max_records = 5;
  other.gather = Gather::kRayTracing;
  other.neighbour_clamping = true;
  other.overture = true;
  EXPECT_THAT(Mistakes(*scene, other), testing::Each(HasSubstr("applies to irradiance-caching alone")));
  EXPECT_EQ(Mistakes(*scene, other).size(), 7u);
}

}  // namespace
}  // namespace flatlight
