// SPDX-License-Identifier: Apache-2.0
// Worlds share their index, and an edited world gets a right one.
#include "core/render/index_cache.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "core/plane/triangulation/triangulation.h"
#include "core/scene/description.h"
#include "core/scene/diagnostic.h"
#include "core/scene/scene.h"

namespace flatlight {
namespace {

// A room with rows of curves, the first of them `shift` aside, and a probe of `count` points on the floor.
std::shared_ptr<const Scene> Rows(double shift, std::uint32_t count, int rows = 30) {
  SceneDescription description;
  description.materials = {{"m", LambertianDescription{{0.5}}}};
  description.curves.push_back(
      {"room", PolylineDescription{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, true}, "m", EmissionDescription{{1}}});
  for (int i = 0; i < rows; ++i) {
    const double x = -0.5 + (i == 0 ? shift : 0), y = -0.9 + 1.8 * i / rows;
    description.curves.push_back(
        {"row " + std::to_string(i), SegmentDescription{{x, y}, {x + 0.7, y + 0.01}}, "m", std::nullopt});
  }
  ProbeDescription probe;
  probe.name = "p";
  probe.curve = "room";
  probe.count = count;
  description.probes.push_back(probe);
  Diagnostics diagnostics;
  return BuildScene(description, diagnostics);
}

TEST(IndexCacheTest, OneWorldHasOneIndexWhateverItsProbes) {
  IndexCache cache(1000);
  const auto caster = cache.For(Rows(0, 8));
  EXPECT_EQ(cache.For(Rows(0, 8)), caster);
  EXPECT_EQ(cache.For(Rows(0, 64)), caster);
  EXPECT_NE(cache.For(Rows(0.1, 8)), caster);
  EXPECT_EQ(cache.For(Rows(0, 8)), caster) << "both are kept";
}

TEST(IndexCacheTest, NothingIsSharedWithOthers) {
  IndexCache cache(1000);
  const auto ada = cache.For(Rows(0, 8), "ada");
  const auto ada_triangles = cache.TrianglesFor(Rows(0, 8), "ada");
  ASSERT_NE(ada_triangles, nullptr);
  EXPECT_NE(cache.For(Rows(0, 8), "bob"), ada);
  EXPECT_NE(cache.TrianglesFor(Rows(0, 8), "bob"), ada_triangles);
  EXPECT_EQ(cache.For(Rows(0, 64), "ada"), ada);
  EXPECT_EQ(cache.TrianglesFor(Rows(0, 8), "ada"), ada_triangles);
}

TEST(IndexCacheTest, AnEditedWorldIsMetAsItIs) {
  IndexCache cache(1000);
  cache.For(Rows(0, 8));
  for (const double shift : {0.1, 0.2, -0.3}) {
    const auto scene = Rows(shift, 8);
    const auto edited = cache.For(scene);
    const RayCaster built(scene);
    EXPECT_EQ(edited->scene().world_hash(), scene->world_hash());
    for (int i = 0; i < 100; ++i) {
      const SurfacePoint from{{-0.99, -0.95 + 0.019 * i}, ElementId::kNone};
      const auto hit = edited->ClosestHit(from, {1, 0.01}), expected = built.ClosestHit(from, {1, 0.01});
      ASSERT_TRUE(hit && expected);
      EXPECT_EQ(hit->distance, expected->distance);
      EXPECT_EQ(hit->element, expected->element);
    }
  }
}

TEST(IndexCacheTest, TheOneUsedLongestAgoGoesFirst) {
  IndexCache cache(100);  // Of 34 elements each: two fit.
  const auto first = cache.For(Rows(0, 8)), second = cache.For(Rows(0.1, 8));
  EXPECT_EQ(cache.For(Rows(0, 8)), first);
  cache.For(Rows(0.2, 8));
  EXPECT_EQ(cache.For(Rows(0, 8)), first);
  EXPECT_NE(cache.For(Rows(0.1, 8)), second);
}

TEST(IndexCacheTest, AWorldTooLargeToKeepIsIndexedAllTheSame) {
  IndexCache cache(10);
  const auto caster = cache.For(Rows(0, 8));
  ASSERT_TRUE(caster);
  EXPECT_NE(cache.For(Rows(0, 8)), caster);
}

TEST(IndexCacheTest, OneWorldHasOneTriangulation) {
  IndexCache cache(1000);
  const auto scene = Rows(0, 8);
  const auto caster = cache.For(scene);
  const auto triangles = cache.TrianglesFor(scene);
  ASSERT_TRUE(triangles);
  EXPECT_EQ(cache.TrianglesFor(Rows(0, 64)), triangles);
  EXPECT_EQ(cache.For(scene), caster) << "still there";
  const auto edited = Rows(0.1, 8);
  cache.For(edited);
  EXPECT_NE(cache.TrianglesFor(edited), triangles);
  EXPECT_EQ(cache.TrianglesFor(scene), triangles) << "both are kept";
}

TEST(IndexCacheTest, TriangulationsCountByTheirMemory) {
  const auto scene = Rows(0, 8);
  const std::size_t elements = scene->elements().size();
  const std::size_t counted = Triangulation::Of(*scene)->bytes() / IndexCache::kElementBytes;
  IndexCache cache(2 * elements + counted);
  cache.For(scene);
  const auto triangles = cache.TrianglesFor(scene);
  cache.For(Rows(0.1, 8));
  EXPECT_EQ(cache.TrianglesFor(scene), triangles) << "there is room for both casters and it";
  const auto caster = cache.For(scene);
  cache.For(Rows(0.2, 8));
  EXPECT_EQ(cache.For(scene), caster) << "the one used longest ago went";
  IndexCache small(elements + counted - 1);
  const auto alone = small.For(scene);
  EXPECT_TRUE(small.TrianglesFor(scene));
  EXPECT_NE(small.TrianglesFor(scene), small.TrianglesFor(scene)) << "no room for it";
  EXPECT_EQ(small.For(scene), alone);
}

// Free points far away have a part in how well coordinates are known.
TEST(IndexCacheTest, ATriangulationIsOfItsCoordinatesAccuracy) {
  SceneDescription description;
  description.materials = {{"m", LambertianDescription{{0}}}};
  description.curves.push_back({"line", SegmentDescription{{1e6, 0}, {1e6 + 1, 0}}, "m", EmissionDescription{{1}}});
  const auto with_point = [&](double x) {
    SceneDescription scene = description;
    ProbeDescription probe;
    probe.name = "p";
    probe.points.push_back({{x, 1}, {0, -1}});
    scene.probes.push_back(probe);
    Diagnostics diagnostics;
    return BuildScene(scene, diagnostics);
  };
  const auto exact = with_point(1e6), rounded = with_point(1.0 / 3);
  ASSERT_NE(exact->coordinate_error(), rounded->coordinate_error());
  ASSERT_EQ(exact->world_hash(), rounded->world_hash());
  IndexCache cache(1000);
  for (const auto& scene : {exact, rounded, exact}) {
    cache.For(scene);
    EXPECT_EQ(cache.TrianglesFor(scene)->coordinate_error(), scene->coordinate_error());
  }
}

}  // namespace
}  // namespace flatlight
