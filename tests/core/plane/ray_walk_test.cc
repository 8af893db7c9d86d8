// SPDX-License-Identifier: Apache-2.0
// The walk through the tree: in scenes of very different sizes, for many rays at once, on every vector unit.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "core/plane/ray_caster.h"
#include "core/scene/element_frame.h"
#include "tests/core/plane/random_curves.h"
#include "tests/support/transport/brute_rays.h"

namespace flatlight {
namespace {

// Clusters of `count` curves, each cluster `size` across, in a room of size 2.
SceneDescription Clusters(Random& random, int clusters, int count, double size) {
  SceneDescription description;
  AddCurve(description, PolylineDescription{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, true});
  for (int c = 0; c < clusters; ++c) {
    const Point2 middle = random.Point();
    for (int i = 0; i < count; ++i) {
      const Point2 a = middle + 0.5 * size * (random.Point() - Point2{});
      if (i % 4 == 3) {
        AddCurve(description, ArcDescription{a, 0.2 * size, random.Uniform(-3, 3), random.Uniform(0.5, 6)});
      } else {
        AddCurve(description, SegmentDescription{a, a + 0.2 * size * random.Direction()});
      }
    }
  }
  return description;
}

// A ray from somewhere in the room, or on a curve, at a place near a curve.
Ray RandomRay(const Scene& scene, Random& random) {
  const auto element = [&]() {
    return static_cast<ElementId>(random.Uniform(0, 1) * static_cast<double>(scene.elements().size()));
  };
  const ElementId from = element(), to = element();
  const Point2 target = FrameAt(scene.element(to), random.Uniform(-0.5, 1.5)).position;
  Ray ray{{random.Point(), ElementId::kNone}, {}};
  if (random.Uniform(0, 1) < 0.5) ray.from = {FrameAt(scene.element(from), random.Uniform(0, 1)).position, from};
  ray.direction = random.Uniform(0.1, 10) * (target - ray.from.position);
  return ray;
}

std::vector<Ray> RandomRays(const Scene& scene, Random& random, std::size_t count) {
  std::vector<Ray> rays(count);
  std::generate(rays.begin(), rays.end(), [&] { return RandomRay(scene, random); });
  return rays;
}

TEST(RayWalkTest, CurvesOfAllSizesAreMetAsByBruteForce) {
  Random random(1);
  for (const double size : {0.5, 1e-3, 1e-5, 1e-7, 1e-9, 1e-11}) {
    const auto scene = BuildWithProbe(Clusters(random, 3, 40, size));
    ASSERT_TRUE(scene);
    const RayCaster caster(scene);
    int near = 0;
    for (const Ray& ray : RandomRays(*scene, random, 3000)) {
      const auto expected = BruteClosestHit(*scene, ray.from, ray.direction);
      const auto hit = caster.ClosestHit(ray.from, ray.direction);
      ASSERT_EQ(hit.has_value(), expected.has_value()) << size;
      if (!hit) continue;
      ASSERT_EQ(hit->distance, expected->distance) << size;
      ASSERT_EQ(hit->element, expected->element) << size;
      near += static_cast<std::uint32_t>(expected->element) >= 4 ? 1 : 0;
    }
    EXPECT_GT(near, 1000) << "rays meet the clusters";
  }
}

TEST(RayWalkTest, RaysFromFarAwayMeetTheScene) {
  Random random(2);
  const auto scene = BuildWithProbe(Clusters(random, 2, 20, 0.1));
  const RayCaster caster(scene);
  for (const double distance : {3.0, 1e3, 1e6, 1e9, 1e12}) {
    for (int i = 0; i < 300; ++i) {
      const SurfacePoint from{Point2{} + distance * random.Direction(), ElementId::kNone};
      const Vector2 direction = random.Point() - from.position;
      const auto expected = BruteClosestHit(*scene, from, direction);
      const auto hit = caster.ClosestHit(from, direction);
      ASSERT_EQ(hit ? hit->distance : INFINITY, expected ? expected->distance : INFINITY) << distance;
    }
  }
}

TEST(RayWalkTest, ThousandsOfTinyCurvesCostNoMoreThanLargeOnes) {
  // Without coordinates of its own a cluster's boxes would all be one: every ray would meet every curve.
  Random random(3);
  const auto scene = BuildWithProbe(Clusters(random, 1, 20000, 1e-6));
  const Bvh bvh(*scene);
  ASSERT_GT(bvh.frames().size(), 1u);
  // A leaf holds 8 of 20000 curves, a fiftieth of the cluster's extent: 255 steps, where the frame is 2 across.
  EXPECT_LT(
      std::count_if(bvh.nodes().begin(), bvh.nodes().end(),
                    [](const BvhNode& node) { return node.kind == BvhNode::Kind::kEnds && 255 * node.step > 0.5f; }),
      10);
}

TEST(RayWalkTest, ManyRaysAtOnceMeetWhatEachMeetsAlone) {
  Random random(4);
  for (const int count : {0, 5, 3000, 30000}) {
    const auto scene = BuildWithProbe(Clusters(random, 1, count, 1.5));
    const RayCaster caster(scene);
    for (const std::size_t size : {0u, 1u, 3u, 64u, 1000u}) {
      const std::vector<Ray> rays = RandomRays(*scene, random, size);
      std::vector<std::optional<Hit>> hits(size);
      caster.ClosestHits(rays, hits);
      std::vector<SurfacePoint> from, to;
      for (const Ray& ray : rays) from.push_back(ray.from), to.push_back({random.Point(), ElementId::kNone});
      const auto visible = std::make_unique<bool[]>(size);
      caster.Visible(from, to, {visible.get(), size});
      for (std::size_t i = 0; i < size; ++i) {
        const auto hit = caster.ClosestHit(rays[i].from, rays[i].direction);
        ASSERT_EQ(hit.has_value(), hits[i].has_value());
        ASSERT_EQ(visible[i], caster.Visible(from[i], to[i]));
        if (!hit) continue;
        ASSERT_EQ(hit->distance, hits[i]->distance);
        ASSERT_EQ(hit->element, hits[i]->element);
        ASSERT_EQ(hit->normal, hits[i]->normal);
      }
    }
  }
}

TEST(RayWalkTest, EveryVectorUnitGivesTheSameBits) {
  Random random(5);
  const auto scene = BuildWithProbe(Clusters(random, 3, 1500, 0.7));
  const RayCaster caster(scene);
  const std::vector<Ray> rays = RandomRays(*scene, random, 2000);
  std::vector<std::optional<Hit>> expected(rays.size());
  caster.ClosestHits(rays, expected);
  const std::int64_t all = hwy::SupportedTargets();
  for (std::int64_t rest = all; rest != 0; rest &= rest - 1) {
    hwy::SetSupportedTargetsForTest(rest & -rest);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    std::vector<std::optional<Hit>> hits(rays.size());
    RayCaster(scene).ClosestHits(rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(hits[i].has_value(), expected[i].has_value()) << hwy::TargetName(rest & -rest);
      if (!hits[i]) continue;
      ASSERT_EQ(hits[i]->distance, expected[i]->distance) << hwy::TargetName(rest & -rest);
      ASSERT_EQ(hits[i]->element, expected[i]->element) << hwy::TargetName(rest & -rest);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace
}  // namespace flatlight
