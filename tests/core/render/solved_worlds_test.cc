// SPDX-License-Identifier: Apache-2.0
// What `reference` found of a world serves the jobs to come: other probes are gathered from it, a smaller target
// refines it, and it is bounded.
#include "core/render/solved_worlds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <utility>

#include "core/execution/thread_pool.h"
#include "core/plane/reference/reference_solver.h"
#include "core/render/index_cache.h"
#include "core/render/plan.h"
#include "core/render/rendering.h"
#include "tests/support/transport/render.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

constexpr std::size_t kPlenty = std::size_t{1} << 30;

Settings Reference(double target) {
  Settings settings;
  settings.method = Method::kReference;
  settings.target_error = target;
  return settings;
}

class CountingExecutor final : public Executor {
 public:
  int threads() const override { return 1; }
  void ParallelFor(std::size_t count, int /*max_threads*/, const std::function<void(std::size_t)>& work) override {
    loops_ += 1;
    for (std::size_t i = 0; i < count; ++i) work(i);
  }
  std::size_t loops() const { return loops_; }

 private:
  std::size_t loops_ = 0;
};

struct Job {
  Ended ended;
  std::size_t loops = 0;  // Of panels, points or equations.
};

Job Finish(const std::shared_ptr<const Scene>& scene, double target, IndexCache& indexes,
           const std::string& sharers = "") {
  const std::unique_ptr<Rendering> rendering =
      StartRendering(scene, PlanFor(*scene, Reference(target)), indexes, sharers);
  CountingExecutor executor;
  const SteadyClock clock;
  const Cancellation never;
  while (!rendering->done()) rendering->Advance(executor, never, clock, kForever);
  return {{rendering->Snapshot(), rendering->end_reason()}, executor.loops()};
}

void ExpectWithinBounds(const Ended& a, const Ended& b) {
  ASSERT_EQ(a.field->probes.size(), b.field->probes.size());
  for (std::size_t p = 0; p < a.field->probes.size(); ++p) {
    const ProbeField &x = a.field->probes[p], &y = b.field->probes[p];
    ASSERT_EQ(x.irradiance.size(), y.irradiance.size());
    for (std::size_t i = 0; i < x.irradiance.size(); ++i) {
      EXPECT_LE(std::abs(x.irradiance[i] - y.irradiance[i]), x.irradiance_error[i] + y.irradiance_error[i]);
      EXPECT_LE(std::abs(x.hessian[i] - y.hessian[i]), x.hessian_error[i] + y.hessian_error[i]);
    }
  }
}

TEST(SolvedWorldsTest, OtherProbesAreGatheredFromWhatIsSolved) {
  const auto first = FurnishedRoom(true, 8).Build(), other = FurnishedRoom(true, 40).Build();
  IndexCache kept(1000, kPlenty), none(1000);
  Finish(first, 1e-5, kept);
  const Job job = Finish(other, 1e-5, kept), anew = Finish(other, 1e-5, none);
  EXPECT_EQ(job.ended.reason, EndReason::kTargetReached);
  ExpectWithinBounds(job.ended, anew.ended);
  EXPECT_LT(3 * job.loops, anew.loops);
}

TEST(SolvedWorldsTest, TheSameJobHasTheSameBits) {
  const auto scene = FurnishedRoom(false, 6).Build();
  IndexCache kept(1000, kPlenty);
  const Job job = Finish(scene, 1e-4, kept), again = Finish(scene, 1e-4, kept);
  EXPECT_LT(4 * again.loops, job.loops);
  EXPECT_EQ(HashOf(*again.ended.field), HashOf(*job.ended.field));
}

TEST(SolvedWorldsTest, WhatIsSolvedForOthersIsNotUsed) {
  const auto scene = FurnishedRoom(false, 6).Build();
  IndexCache kept(1000, kPlenty), none(1000);
  const Job ada = Finish(scene, 1e-4, kept, "ada"), bob = Finish(scene, 1e-4, kept, "bob");
  EXPECT_EQ(bob.loops, ada.loops);
  EXPECT_EQ(HashOf(*bob.ended.field), HashOf(*Finish(scene, 1e-4, none).ended.field));
  EXPECT_LT(4 * Finish(scene, 1e-4, kept, "ada").loops, ada.loops);
  EXPECT_LT(4 * Finish(scene, 1e-4, kept, "bob").loops, ada.loops);
}

TEST(SolvedWorldsTest, ASmallerTargetRefines) {
  const auto scene = FurnishedRoom(true, 8).Build();
  IndexCache kept(1000, kPlenty), none(1000);
  Finish(scene, 1e-4, kept);
  auto world = kept.solved_worlds()->Take(*scene, 1, {});
  ASSERT_NE(world, nullptr);
  const std::size_t bytes = world->bytes();
  kept.solved_worlds()->Keep(std::move(world));
  // The light alone has room here.
  IndexCache light(1000, bytes - 1);
  Finish(scene, 1e-4, light);
  const Job anew = Finish(scene, 1e-6, none);
  for (IndexCache* cache : {&kept, &light}) {
    const Job refined = Finish(scene, 1e-6, *cache);
    EXPECT_EQ(refined.ended.reason, EndReason::kTargetReached);
    ExpectWithinBounds(refined.ended, anew.ended);
    EXPECT_LT(refined.loops, anew.loops);
  }
}

std::unique_ptr<SolvedWorld> Solved(const std::shared_ptr<const Scene>& scene, double target) {
  ReferenceOptions options;
  options.channels = 1;
  options.target_error = target;
  ThreadPool pool(1);
  ReferenceSolver solver(scene, std::make_shared<const RayCaster>(scene), options);
  const SteadyClock clock;
  const Cancellation never;
  solver.Advance(pool, 1, never, clock, kForever);
  return solver.TakeWorld();
}

std::shared_ptr<const Scene> RoomWith(double reflectance) {
  SceneMaker maker = SquareRoom({.reflectance = {reflectance}}, 2);
  maker.Segment("lamp", {0.4, 0.9}, {-0.4, 0.9}, {.radiance = {1}});
  return maker.Build();
}

TEST(SolvedWorldsTest, WhatWasUsedLongestAgoGoesFirst) {
  const auto a = RoomWith(0.5), b = RoomWith(0.6), c = RoomWith(0.7);
  const std::size_t bytes = Solved(a, 1e-3)->bytes();
  EXPECT_GT(bytes, 10'000u);
  SolvedWorlds worlds(2 * bytes + bytes / 2);
  worlds.Keep(Solved(a, 1e-3));
  worlds.Keep(Solved(b, 1e-3));
  worlds.Keep(worlds.Take(*a, 1, {}));
  worlds.Keep(Solved(c, 1e-3));
  EXPECT_NE(worlds.Take(*a, 1, {}), nullptr);
  EXPECT_EQ(worlds.Take(*b, 1, {}), nullptr);
  EXPECT_NE(worlds.Take(*c, 1, {}), nullptr);
  EXPECT_EQ(worlds.Take(*c, 1, {}), nullptr);
}

TEST(SolvedWorldsTest, OnlyWhatIsAskedForIsGiven) {
  const auto a = RoomWith(0.5);
  SolvedWorlds worlds(kPlenty);
  worlds.Keep(Solved(a, 1e-3));
  EXPECT_EQ(worlds.Take(*RoomWith(0.51), 1, {}), nullptr);
  EXPECT_EQ(worlds.Take(*a, 3, {}), nullptr);
  EXPECT_EQ(worlds.Take(*a, 1, 2u), nullptr);
  EXPECT_NE(worlds.Take(*a, 1, {}), nullptr);
}

TEST(SolvedWorldsTest, TheFinerOfTwoStays) {
  const auto a = RoomWith(0.5);
  SolvedWorlds worlds(kPlenty);
  auto fine = Solved(a, 1e-6);
  const std::size_t panels = fine->radiosity->mesh().size();
  worlds.Keep(std::move(fine));
  worlds.Keep(Solved(a, 1e-2));
  EXPECT_EQ(worlds.Take(*a, 1, {})->radiosity->mesh().size(), panels);
}

}  // namespace
}  // namespace flatlight
