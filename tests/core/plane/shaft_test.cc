// SPDX-License-Identifier: Apache-2.0
// What a shaft says of the lines in it, against rays that are cast along them.
#include "core/plane/shaft.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <string>

#include "core/plane/ray_caster.h"
#include "core/scene/element_frame.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

// Short and long pieces, straight and arced; some share corners, some end on others.
std::shared_ptr<const Scene> Clutter(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(-1, 1);
  std::uniform_real_distribution<double> unit(0, 1);
  SceneMaker maker;
  Point2 last{place(random), place(random)};
  for (int i = 0; i < 14; ++i) {
    const std::string name = "curve " + std::to_string(i);
    const Point2 a = unit(random) < 0.3 ? last : Point2{place(random), place(random)};
    const double size = unit(random) < 0.5 ? 0.2 : 1.5;
    if (unit(random) < 0.75) {
      last = a + Vector2{size * place(random), size * place(random)};
      maker.Segment(name, a, last);
    } else {
      const double sweep = (unit(random) < 0.5 ? 1 : -1) * (0.1 + 6 * unit(random));
      maker.Arc(name, {a, 0.05 + 0.4 * unit(random), 6 * unit(random), sweep});
    }
  }
  maker.PointProbe({0, 0}, {0, 1});
  return maker.Build();
}

SurfacePoint Somewhere(const Scene& scene, std::size_t element, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  return {FrameAt(scene.elements()[element], unit(random)).position, static_cast<ElementId>(element)};
}

struct Counts {
  int clear = 0;
  int hidden = 0;
  int uncertain = 0;
};

void ExpectTrue(Passage passage, const RayCaster& caster, const SurfacePoint& from, const SurfacePoint& to,
                const std::string& where) {
  if (passage == Passage::kUncertain) return;
  EXPECT_EQ(caster.Visible(from, to), passage == Passage::kClear) << where;
}

void Count(Passage passage, Counts& counts) {
  ++(passage == Passage::kClear ? counts.clear : passage == Passage::kHidden ? counts.hidden : counts.uncertain);
}

TEST(ShaftTest, TellsTheTruthAboutEveryRay) {
  Counts points;
  Counts elements;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const std::shared_ptr<const Scene> scene = Clutter(seed);
    const RayCaster caster(scene);
    std::mt19937_64 random(seed);
    for (std::size_t to = 0; to < scene->elements().size(); ++to) {
      const Element& target = scene->elements()[to];
      for (std::size_t from = 0; from < scene->elements().size(); ++from) {
        const Element& source = scene->elements()[from];
        // Own circles are the caller's affair: see Sights.
        if (source.kind == Element::Kind::kArc || target.kind == Element::Kind::kArc || from == to) continue;
        const OwnCarriers own{source.carrier, target.carrier};
        const std::string where =
            "scene " + std::to_string(seed) + " from " + std::to_string(from) + " to " + std::to_string(to);
        const Passage all = PassageBetween(*scene, caster.bvh(), CornersOf(source), CornersOf(target), own);
        Count(all, elements);
        for (int i = 0; i < 4; ++i) {
          const SurfacePoint start = Somewhere(*scene, from, random);
          ExpectTrue(all, caster, start, Somewhere(*scene, to, random), where);
          const Passage one = PassageBetween(*scene, caster.bvh(), CornersOf(start.position), CornersOf(target), own);
          Count(one, points);
          for (int k = 0; k < 8; ++k) ExpectTrue(one, caster, start, Somewhere(*scene, to, random), where);
        }
      }
    }
  }
  // The test has seen enough of each kind.
  for (const Counts& counts : {points, elements}) {
    EXPECT_GT(counts.clear, 100);
    EXPECT_GT(counts.hidden, 50);
    EXPECT_GT(counts.uncertain, 100);
  }
}

// Every wall of a convex room sees every other one, though neighbours share corners with the shaft; a table in the room
// is in the way of some, and hides the floor from a lamp that is smaller than it.
TEST(ShaftTest, NeighboursAtCornersAreNotInTheWay) {
  SceneMaker maker = SquareRoom({.reflectance = {0.5}}, 1);
  const std::shared_ptr<const Scene> room = maker.Build();
  const Bvh bvh(*room);
  for (const Element& from : room->elements()) {
    for (const Element& to : room->elements()) {
      if (from.carrier == to.carrier) continue;
      EXPECT_EQ(PassageBetween(*room, bvh, CornersOf(from), CornersOf(to), {from.carrier, to.carrier}),
                Passage::kClear);
    }
  }
  maker.Segment("table", {-0.5, 0}, {0.5, 0});
  maker.Segment("lamp", {0.1, 0.9}, {-0.1, 0.9}, {.radiance = {1}});
  const std::shared_ptr<const Scene> furnished = maker.Build();
  const Bvh tree(*furnished);
  const Element& floor = furnished->elements()[0];
  const Element& lamp = furnished->elements()[5];
  const auto passage = [&](const Corners& from) {
    return PassageBetween(*furnished, tree, from, CornersOf(lamp), {floor.carrier, lamp.carrier});
  };
  EXPECT_EQ(passage(CornersOf(floor)), Passage::kUncertain);
  EXPECT_EQ(passage(CornersOf(Point2{0, -1})), Passage::kHidden);
  EXPECT_EQ(passage(CornersOf(furnished->elements()[2])), Passage::kClear);
}

TEST(ShaftTest, CornersHoldTheWholeArc) {
  SceneMaker maker;
  maker.Arc("arc", {{0.2, 0.1}, 0.5, 0.3, -1.5});
  maker.Arc("flat", {{0, 1000}, 1000, -std::numbers::pi / 2, 1e-4}).Probe("arc", 1);
  const std::shared_ptr<const Scene> scene = maker.Build();
  for (const Element& arc : scene->elements()) {
    const Corners corners = CornersOf(arc);
    ASSERT_EQ(corners.count, 3u);
    for (int i = 0; i <= 16; ++i) {
      const Point2 p = FrameAt(arc, i / 16.0).position;
      const double turn = Cross(corners.point[1] - corners.point[0], corners.point[2] - corners.point[0]) > 0 ? 1 : -1;
      for (std::size_t k = 0; k < 3; ++k) {
        const Point2 c = corners.point[k];
        EXPECT_GT(turn * Cross(corners.point[(k + 1) % 3] - c, p - c), -1e-14);
      }
    }
    EXPECT_FALSE(CircleHolds(arc, corners));
  }
}

}  // namespace
}  // namespace flatlight
