// SPDX-License-Identifier: Apache-2.0
// Renderings that are broken off, written down and taken up again, on other threads: they end with the same bits.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/execution/thread_pool.h"
#include "core/render/plan.h"
#include "core/render/rendering.h"
#include "tests/support/transport/render.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

constexpr std::size_t kAnyLength = std::numeric_limits<std::size_t>::max();

// Every look at it takes a while: time that depends on nothing but the work.
class TickingClock final : public Clock {
 public:
  explicit TickingClock(Duration tick = std::chrono::microseconds(10)) : tick_(tick) {}
  // All threads of a slice look at it.
  Time Now() const override { return Time(Duration((ticks_ += 1) * tick_)); }
  Time now_without_tick() const { return Time(Duration(ticks_.load() * tick_)); }

 private:
  Duration tick_;
  mutable std::atomic<Duration::rep> ticks_ = 0;
};

struct Case {
  std::string name;
  std::shared_ptr<const Scene> scene;
  Settings settings;
};

Settings Of(Method method, std::optional<std::uint32_t> samples, std::optional<double> target_error = {}) {
  Settings settings;
  settings.method = method;
  settings.samples = samples;
  settings.target_error = target_error;
  return settings;
}

std::vector<Case> Cases() {
  const auto room = FurnishedRoom(false, 5).Build();
  const auto pictures = FurnishedRoom(false, 2).Picture({-0.9, -0.9}, {0.9, 0.9}, 13, 9).Build();
  const auto picture = UnitLight().Picture({0.1, 0.1}, {0.9, 0.7}, 20, 10).Build();
  // Light by way of a small thing, which few samples meet.
  const auto rare = SceneMaker()
                        .Segment("floor", {-1, 0}, {1, 0})
                        .Segment("lamp", {-0.1, 0.9}, {0.1, 0.9}, {.radiance = {1}})
                        .Segment("patch", {0.01, 1}, {-0.01, 1}, {.reflectance = {0.9}})
                        .Segment("wall", {0.3, 1.1}, {0.3, 1}, {.reflectance = {0.9}})
                        .Probe("floor", 40)
                        .Build();
  Settings shown = Of(Method::kPathTracing, 1024, 0.1);
  shown.no_skip = {"converged-points"};
  Settings exact;
  exact.max_bounces = 0;
  exact.method = Method::kExact;
  Settings direct_picture = Of(Method::kPathTracing, {}, 0.05);
  direct_picture.max_bounces = 0;
  const auto long_room = FurnishedRoom(false, 40).Build();
  Settings by_rays = Of(Method::kIrradianceCaching, 64), by_distance = by_rays;
  by_rays.max_bounces = 1;
  by_rays.tolerance = 3e-3;
  by_distance.error_control = ErrorControl::kSplitSphere;
  by_distance.extrapolation = 1;
  by_distance.max_records = 70;
  return {{"path tracing", room, Of(Method::kPathTracing, 300)},
          {"path tracing to a target", room, Of(Method::kPathTracing, 4096, 0.1)},
          {"path tracing of rare light", rare, Of(Method::kPathTracing, 4096, 0.1)},
          {"path tracing of converged points", room, shown},
          {"ray tracing", room, Of(Method::kRayTracing, 1024)},
          {"ray tracing to a target", room, Of(Method::kRayTracing, 4096, 0.1)},
          {"points and pictures", pictures, Of(Method::kPathTracing, 256)},
          {"pictures to a target", picture, direct_picture},
          {"exact", room, exact},
          {"irradiance caching by rays", long_room, by_rays},
          {"irradiance caching by distance", long_room, by_distance}};
}

// Broken off after every `slices` calls.
Ended RenderInPieces(const Case& which, int slices, int& checkpoints) {
  const Plan plan = PlanFor(*which.scene, which.settings);
  const Cancellation never;
  std::unique_ptr<Rendering> rendering = StartRendering(which.scene, plan);
  for (int piece = 0; !rendering->done(); ++piece) {
    ThreadPool pool(1 + piece % 3);
    const TickingClock clock;
    for (int i = 0; i < slices && !rendering->done(); ++i) {
      rendering->Advance(pool, never, clock, Clock::Duration(0));
    }
    const std::string checkpoint = rendering->Checkpoint(kAnyLength);
    if (checkpoint.empty()) continue;
    ++checkpoints;
    rendering = StartRendering(which.scene, plan);
    EXPECT_TRUE(rendering->Resume(checkpoint)) << which.name;
    EXPECT_EQ(rendering->Checkpoint(kAnyLength), checkpoint) << which.name;
  }
  return {rendering->Snapshot(), rendering->end_reason()};
}

TEST(CheckpointTest, ARenderingInPiecesHasTheBitsOfOneInOneGo) {
  for (const Case& which : Cases()) {
    const Ended whole = Render(which.scene, which.settings, 2);
    for (const int slices : {1, 2, 10}) {
      int checkpoints = 0;
      const Ended pieces = RenderInPieces(which, slices, checkpoints);
      EXPECT_GT(checkpoints, slices == 1 ? 1 : 0) << which.name;
      EXPECT_EQ(HashOf(*pieces.field), HashOf(*whole.field)) << which.name << ", " << slices << " slices a piece";
      EXPECT_EQ(pieces.field->rays, whole.field->rays) << which.name;
      EXPECT_EQ(pieces.reason, whole.reason) << which.name;
    }
  }
}

// These begin with work that is done again each time, or come so far as to be written down but now and then.
TEST(CheckpointTest, WhatIsWrittenDownSeldomHasTheSameBitsToo) {
  const auto room = FurnishedRoom(false, 20).Build();
  Settings panels = Of(Method::kIrradianceCaching, {}), photons = panels, densities = Of(Method::kPhotonMapping, {});
  panels.max_bounces = 1;
  photons.gather = Gather::kPhotonMap;
  photons.photons = 3000;
  photons.samples = 64;
  densities.photons = 40'000;
  densities.final_gather = false;
  Settings gather = Of(Method::kPhotonMapping, 64);
  gather.photons = 40'000;
  for (const Case& which : {Case{"caching from panels", room, panels}, Case{"caching from photons", room, photons},
                            Case{"densities", room, densities}, Case{"final gather", room, gather}}) {
    const Ended whole = Render(which.scene, which.settings, 2);
    for (const int slices : {1, 7}) {
      int checkpoints = 0;
      const Ended pieces = RenderInPieces(which, slices, checkpoints);
      EXPECT_GT(checkpoints, 0) << which.name;
      EXPECT_EQ(HashOf(*pieces.field), HashOf(*whole.field)) << which.name << ", " << slices << " slices a piece";
      EXPECT_EQ(pieces.field->records.size(), whole.field->records.size()) << which.name;
      EXPECT_EQ(pieces.field->rays, whole.field->rays) << which.name;
      EXPECT_EQ(pieces.field->photons, whole.field->photons) << which.name;
      EXPECT_EQ(pieces.reason, whole.reason) << which.name;
    }
  }
}

std::string CheckpointAfter(const Case& which, int slices, std::size_t most_bytes = kAnyLength) {
  const auto rendering = StartRendering(which.scene, PlanFor(*which.scene, which.settings));
  ThreadPool pool(1);
  const TickingClock clock;
  const Cancellation never;
  for (int i = 0; i < slices; ++i) rendering->Advance(pool, never, clock, Clock::Duration(0));
  return rendering->Checkpoint(most_bytes);
}

bool Resumes(const Case& which, const std::string& checkpoint) {
  return StartRendering(which.scene, PlanFor(*which.scene, which.settings))->Resume(checkpoint);
}

TEST(CheckpointTest, WhatIsNoCheckpointOfTheRenderingIsRefused) {
  const std::vector<Case> cases = Cases();
  for (const Case& which : cases) {
    const std::string whole = CheckpointAfter(which, 5);
    ASSERT_FALSE(whole.empty()) << which.name;
    EXPECT_TRUE(Resumes(which, whole));
    EXPECT_FALSE(Resumes(which, whole + '\0')) << which.name;
    EXPECT_FALSE(Resumes(which, "")) << which.name;
    // Cut anywhere: at few places of many, for it takes a while.
    for (std::size_t cut = 0; cut < whole.size(); cut += 1 + whole.size() / 16) {
      EXPECT_FALSE(Resumes(which, whole.substr(0, cut))) << which.name << " cut to " << cut;
    }
  }
  // Of another number of points.
  Case more = cases[0];
  more.scene = FurnishedRoom(false, 6).Build();
  EXPECT_FALSE(Resumes(more, CheckpointAfter(cases[0], 5)));
  EXPECT_FALSE(Resumes(cases[1], CheckpointAfter(cases[3], 5)));
}

TEST(CheckpointTest, IsNoLongerThanAllowed) {
  for (const Case& which : Cases()) {
    const std::size_t length = CheckpointAfter(which, 5).size();
    EXPECT_EQ(CheckpointAfter(which, 5, length).size(), length) << which.name;
    EXPECT_TRUE(CheckpointAfter(which, 5, length - 1).empty()) << which.name;
  }
}

TEST(CheckpointTest, TheTimeBeforeItCountsInATimeLimit) {
  Case which{"time limit", FurnishedRoom(true, 5).Build(), {}};
  which.settings.time_limit = 4;
  for (const Method method : {Method::kPathTracing, Method::kRayTracing}) {
    which.settings.method = method;
    ThreadPool pool(1);
    const Cancellation never;
    const TickingClock first(std::chrono::milliseconds(5));
    auto rendering = StartRendering(which.scene, PlanFor(*which.scene, which.settings));
    const Clock::Time begin = first.now_without_tick();
    while (first.now_without_tick() - begin < std::chrono::seconds(2)) {
      rendering->Advance(pool, never, first, Clock::Duration(0));
    }
    ASSERT_FALSE(rendering->done());
    const std::string checkpoint = rendering->Checkpoint(kAnyLength);
    rendering = StartRendering(which.scene, PlanFor(*which.scene, which.settings));
    ASSERT_TRUE(rendering->Resume(checkpoint));
    const TickingClock second(std::chrono::milliseconds(5));
    const Clock::Time again = second.now_without_tick();
    while (!rendering->done()) rendering->Advance(pool, never, second, Clock::Duration(0));
    EXPECT_EQ(rendering->end_reason(), EndReason::kTimeLimit);
    EXPECT_LT(second.now_without_tick() - again, std::chrono::milliseconds(2200));
  }
}

}  // namespace
}  // namespace flatlight
