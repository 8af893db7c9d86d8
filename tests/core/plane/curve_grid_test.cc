// SPDX-License-Identifier: Apache-2.0
// The grid that rays walk through: scenes of very uneven density, and edits.
#include "core/plane/curve_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "core/plane/ray_caster.h"
#include "core/scene/element_frame.h"
#include "tests/core/plane/random_curves.h"
#include "tests/support/transport/brute_rays.h"

namespace flatlight {
namespace {

// Curves of `size` in a square of `extent`.
void AddCluster(SceneDescription& description, Random& random, Point2 middle, double extent, double size, int count) {
  for (int i = 0; i < count; ++i) {
    const Point2 a = middle + extent * (random.Point() - Point2{});
    AddCurve(description, SegmentDescription{a, a + size * random.Direction()});
  }
}

// From anywhere, or from a curve, to places on curves and beside them.
void ExpectAsBruteForce(const RayCaster& caster, Random& random, int rays = 300) {
  const Scene& scene = caster.scene();
  for (int i = 0; i < rays; ++i) {
    const auto any = [&] {
      return static_cast<ElementId>(random.Uniform(0, 1) * static_cast<double>(scene.elements().size()));
    };
    SurfacePoint from{random.Point(), ElementId::kNone};
    const ElementId start = any();
    if (i % 2 == 0) from = {FrameAt(scene.element(start), random.Uniform(0, 1)).position, start};
    const Point2 target = FrameAt(scene.element(any()), random.Uniform(-0.5, 1.5)).position;
    const Vector2 direction = i % 7 == 0 ? Vector2{0, -1} : random.Uniform(0.1, 10) * (target - from.position);
    const auto expected = BruteClosestHit(scene, from, direction);
    const auto hit = caster.ClosestHit(from, direction);
    ASSERT_EQ(hit.has_value(), expected.has_value()) << i;
    ASSERT_EQ(caster.Visible(from, {target, ElementId::kNone}), BruteVisible(scene, from, {target, ElementId::kNone}));
    ASSERT_EQ(caster.Touches({target, ElementId::kNone}), BruteTouches(scene, {target, ElementId::kNone}));
    if (!hit) continue;
    ASSERT_EQ(hit->distance, expected->distance) << i;
    ASSERT_EQ(hit->element, expected->element) << i;
  }
}

TEST(CurveGridTest, UnevenScenesAreMetAsByBruteForce) {
  Random random(1);
  for (const double extent : {0.1, 1e-3, 1e-5, 1e-8}) {
    SceneDescription description = Room(random, 30, 0.3);
    AddCluster(description, random, {0.31, -0.2}, extent, 0.1 * extent, 400);
    AddCluster(description, random, {0.31 + 0.5 * extent, -0.2}, 0.01 * extent, 1e-3 * extent, 400);
    // From one side of the room to the other, among them.
    for (int i = 0; i < 20; ++i) {
      AddCurve(description, SegmentDescription{{-1, random.Uniform(-1, 1)}, {1, random.Uniform(-1, 1)}});
    }
    const auto scene = BuildWithProbe(description);
    ASSERT_TRUE(scene);
    const CurveGrid grid(*scene);
    EXPECT_GT(grid.frames().size(), 1u) << "a grid in the grid";
    ExpectAsBruteForce(RayCaster(scene), random, 2000);
  }
}

TEST(CurveGridTest, ManyCurvesThroughOnePointTakeNoMoreCellsThanOthers) {
  Random random(2);
  SceneDescription description;
  for (int i = 0; i < 2000; ++i) {
    const Vector2 half = random.Direction();
    AddCurve(description, SegmentDescription{Point2{0.1, 0.1} - half, Point2{0.1, 0.1} + half});
  }
  const auto scene = BuildWithProbe(description);
  ASSERT_TRUE(scene);
  EXPECT_LT(CurveGrid(*scene).blocks().size() * CurveBlock::kWidth, 20 * scene->elements().size());
  ExpectAsBruteForce(RayCaster(scene), random, 50);
}

TEST(CurveGridTest, LongCurvesAreCopiedAFewTimesOnly) {
  Random random(3);
  const auto scene = BuildWithProbe(Room(random, 70000, 0.3));
  ASSERT_TRUE(scene);
  EXPECT_LT(static_cast<double>(CurveGrid(*scene).blocks().size() * CurveBlock::kWidth),
            10 * static_cast<double>(scene->elements().size()));
  ExpectAsBruteForce(RayCaster(scene), random, 50);
}

TEST(CurveGridTest, ParallelCurvesMakeStripes) {
  for (const bool upright : {false, true}) {
    SceneDescription description;
    for (int i = 0; i < 3000; ++i) {
      const double at = 1e-3 * i;
      AddCurve(description, upright ? SegmentDescription{{at, 0}, {at, 3}} : SegmentDescription{{0, at}, {3, at}});
    }
    const auto scene = BuildWithProbe(description);
    ASSERT_TRUE(scene);
    const CurveGrid grid(*scene);
    const GridFrame& frame = grid.frames()[0];
    EXPECT_EQ(upright ? frame.rows : frame.columns, 1u);
    EXPECT_GT(upright ? frame.columns : frame.rows, 300u);
    Random random(10);
    ExpectAsBruteForce(RayCaster(scene), random);
  }
}

TEST(CurveGridTest, CurvesOnOneLineMakeAGridOfOneRow) {
  SceneDescription description;
  for (int i = 0; i < 500; ++i) AddCurve(description, SegmentDescription{{0.01 * i, 0}, {0.01 * i + 0.004, 0}});
  const auto scene = BuildWithProbe(description);
  ASSERT_TRUE(scene);
  EXPECT_LT(CurveGrid(*scene).cells().size(), 5000u);
  Random random(4);
  ExpectAsBruteForce(RayCaster(scene), random);
}

TEST(CurveGridTest, FollowsEdits) {
  Random random(5);
  for (const int count : {4, 60, 1000}) {
    SceneDescription description = Room(random, count, 0.1);
    AddCluster(description, random, {0.2, 0.3}, 1e-4, 1e-5, count);
    std::shared_ptr<const RayCaster> caster = std::make_shared<RayCaster>(BuildWithProbe(description));
    const bool with_tree = count == 60;
    if (with_tree) caster->bvh();
    for (int edit = 0; edit < 20; ++edit) {
      for (int i = 0; i < 1 + count / 50; ++i) {
        const auto c = static_cast<std::size_t>(random.Uniform(1, static_cast<double>(description.curves.size())));
        // Of the cluster's, some leave it.
        const bool small = c > static_cast<std::size_t>(count) && i % 2 == 0;
        Move(description.curves[c], (small ? 1e-5 : 0.02) * random.Direction());
      }
      caster = caster->Refit(BuildWithProbe(description));
      ASSERT_TRUE(caster) << count << " curves, edit " << edit;
      ExpectAsBruteForce(*caster, random);
    }
  }
}

TEST(CurveGridTest, GivesUpWhenANewGridIsBetter) {
  Random random(6);
  SceneDescription description = Room(random, 400, 0.02);
  const RayCaster caster(BuildWithProbe(description));
  SceneDescription shifted = description;
  for (std::size_t c = 1; c < 200; ++c) Move(shifted.curves[c], {1e-3, 0});
  EXPECT_FALSE(caster.Refit(BuildWithProbe(shifted))) << "half of the curves moved";
  SceneDescription more = description;
  AddCurve(more, SegmentDescription{{0, 0}, {0.1, 0}});
  EXPECT_FALSE(caster.Refit(BuildWithProbe(more))) << "another number of curves";
}

TEST(CurveGridTest, WhatEditsLeaveBehindIsBounded) {
  Random random(8);
  SceneDescription description = Room(random, 400, 0.02);
  auto scene = BuildWithProbe(description);
  CurveGrid grid(*scene);
  const std::size_t built = grid.blocks().size();
  for (int edit = 0; edit < 300; ++edit) {
    for (std::size_t c = 1; c < 90; ++c) Move(description.curves[c], {edit % 2 == 0 ? 0.05 : -0.05, 0});
    const auto after = BuildWithProbe(description);
    std::optional<CurveGrid> refitted = grid.Refit(*scene, *after);
    grid = refitted ? std::move(*refitted) : CurveGrid(*after);
    scene = after;
    ASSERT_LT(grid.blocks().size(), 4 * built + 4096);
  }
}

// In the open: nothing stops them before.
TEST(CurveGridTest, RaysFromFarAwayMeetTinyCurves) {
  Random random(7);
  SceneDescription description;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0}) AddCurve(description, SegmentDescription{{x, y}, {0.99 * x, 0.98 * y}});
  const Point2 middle{0.31, -0.2};
  AddCluster(description, random, middle, 1e-7, 1e-8, 400);
  AddCluster(description, random, middle, 1e-10, 1e-11, 400);
  const auto scene = BuildWithProbe(description);
  const RayCaster caster(scene);
  for (const double distance : {3.0, 300.0, 3e4, 3e8}) {
    int hits = 0;
    for (int i = 0; i < 400; ++i) {
      const SurfacePoint from{Point2{} + distance * random.Direction(), ElementId::kNone};
      const double wide = i % 2 == 0 ? 1e-7 : 1e-10;
      const Vector2 direction = middle + wide * (random.Point() - Point2{}) - from.position;
      const auto expected = BruteClosestHit(*scene, from, direction);
      const auto hit = caster.ClosestHit(from, direction);
      ASSERT_EQ(hit ? hit->distance : INFINITY, expected ? expected->distance : INFINITY) << distance;
      if (!hit) continue;
      ASSERT_EQ(hit->element, expected->element) << distance;
      ++hits;
    }
    EXPECT_GT(hits, 40) << distance;
  }
}

}  // namespace
}  // namespace flatlight
