// SPDX-License-Identifier: Apache-2.0
// A tree that follows a scene's edits meets what brute force meets, and gives up when a new one would be better.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>

#include "core/plane/bvh.h"
#include "core/plane/ray_caster.h"
#include "tests/core/plane/random_curves.h"
#include "tests/support/transport/brute_rays.h"

namespace flatlight {
namespace {

// A room, so that edits inside leave its extent, and with it all other coordinates, as they are.
SceneDescription Room(Random& random, int count, double size) {
  SceneDescription description;
  AddCurve(description, PolylineDescription{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, true});
  for (int i = 0; i < count; ++i) {
    const Point2 a{random.Uniform(-0.9, 0.9), random.Uniform(-0.9, 0.9)};
    if (i % 5 == 0) {
      AddCurve(description, ArcDescription{a, 0.5 * size, random.Uniform(-3, 3), 1.2});
    } else {
      AddCurve(description, SegmentDescription{a, a + size * random.Direction()});
    }
  }
  return description;
}

void Move(CurveDescription& curve, Vector2 by) {
  if (auto* segment = std::get_if<SegmentDescription>(&curve.shape)) {
    segment->a = segment->a + by, segment->b = segment->b + by;
  } else if (auto* arc = std::get_if<ArcDescription>(&curve.shape)) {
    arc->center = arc->center + by;
  }
}

void ExpectAsBruteForce(const RayCaster& caster, Random& random) {
  for (int i = 0; i < 500; ++i) {
    const SurfacePoint from{random.Point(), ElementId::kNone};
    const Vector2 direction = random.Direction();
    const auto expected = BruteClosestHit(caster.scene(), from, direction);
    const auto hit = caster.ClosestHit(from, direction);
    ASSERT_EQ(hit.has_value(), expected.has_value());
    if (!hit) continue;
    ASSERT_EQ(hit->distance, expected->distance);
    ASSERT_EQ(hit->element, expected->element);
  }
}

TEST(BvhRefitTest, FollowsEdits) {
  Random random(1);
  for (const int count : {4, 60, 1000}) {
    SceneDescription description = Room(random, count, 0.1);
    std::shared_ptr<const Scene> scene = BuildWithProbe(description);
    auto caster = std::make_unique<RayCaster>(scene);
    for (int edit = 0; edit < 10; ++edit) {
      for (int i = 0; i < 1 + count / 50; ++i) {
        const auto c = static_cast<std::size_t>(random.Uniform(1, count));
        Move(description.curves[c], 0.02 * random.Direction());
      }
      const auto after = BuildWithProbe(description);
      std::optional<Bvh> bvh = caster->bvh().Refit(*scene, *after);
      ASSERT_TRUE(bvh) << count << " curves, edit " << edit;
      scene = after;
      caster = std::make_unique<RayCaster>(scene, std::move(*bvh));
      ExpectAsBruteForce(*caster, random);
    }
  }
}

TEST(BvhRefitTest, FollowsEditsOfTinyCurves) {
  Random random(2);
  SceneDescription description = Room(random, 20, 0.2);
  for (int i = 0; i < 200; ++i) {
    const Point2 a = Point2{0.3, 0.2} + 1e-6 * (random.Point() - Point2{});
    AddCurve(description, SegmentDescription{a, a + 1e-7 * random.Direction()});
  }
  const auto scene = BuildWithProbe(description);
  const Bvh built(*scene);
  ASSERT_GT(built.frames().size(), 1u);
  Move(description.curves.back(), {2e-7, 1e-7});
  const auto near = BuildWithProbe(description);
  std::optional<Bvh> bvh = built.Refit(*scene, *near);
  ASSERT_TRUE(bvh);
  const RayCaster caster(near, std::move(*bvh));
  for (int i = 0; i < 500; ++i) {
    const SurfacePoint from{random.Point(), ElementId::kNone};
    const Vector2 direction = Point2{0.3, 0.2} + 1e-6 * (random.Point() - Point2{}) - from.position;
    const auto expected = BruteClosestHit(*near, from, direction);
    const auto hit = caster.ClosestHit(from, direction);
    ASSERT_EQ(hit ? hit->distance : INFINITY, expected ? expected->distance : INFINITY);
  }
  // Far out of the cluster's own coordinates.
  Move(description.curves.back(), {0.1, 0});
  EXPECT_FALSE(built.Refit(*scene, *BuildWithProbe(description)));
}

TEST(BvhRefitTest, GivesUpWhenANewTreeIsBetter) {
  Random random(3);
  SceneDescription description = Room(random, 400, 0.02);
  const auto scene = BuildWithProbe(description);
  const Bvh built(*scene);
  SceneDescription shuffled = description;
  for (std::size_t c = 1; c < 90; ++c) Move(shuffled.curves[c], 0.8 * random.Direction());
  EXPECT_FALSE(built.Refit(*scene, *BuildWithProbe(shuffled))) << "boxes would span the room";
  SceneDescription shifted = description;
  for (std::size_t c = 1; c < 200; ++c) Move(shifted.curves[c], {1e-3, 0});
  EXPECT_FALSE(built.Refit(*scene, *BuildWithProbe(shifted))) << "half of the curves moved";
  SceneDescription more = description;
  AddCurve(more, SegmentDescription{{0, 0}, {0.1, 0}});
  EXPECT_FALSE(built.Refit(*scene, *BuildWithProbe(more))) << "another number of curves";
}

}  // namespace
}  // namespace flatlight
