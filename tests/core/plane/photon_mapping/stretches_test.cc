// SPDX-License-Identifier: Apache-2.0
#include "core/plane/photon_mapping/stretches.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/scene/element_frame.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;

// The place at a fraction of an element of a curve.
SidePlace PlaceOn(const Stretches& stretches, const Scene& scene, std::size_t curve, std::uint32_t element,
                  double fraction, Side side = Side::kFront) {
  const auto id = static_cast<ElementId>(scene.curves()[curve].first_element + element);
  return stretches.Locate(id, FrameAt(scene.element(id), fraction).position, side);
}

TEST(StretchesTest, CornersAndSidesPart) {
  const auto scene = SceneMaker().Polyline("corner", {{0, 1}, {0, 0}, {2, 0}}, false).Probe("corner", 1).Build();
  const Stretches stretches(*scene);
  EXPECT_EQ(stretches.count(), 2u);
  const SidePlace wall = PlaceOn(stretches, *scene, 0, 0, 0.75), floor = PlaceOn(stretches, *scene, 0, 1, 0.25);
  EXPECT_NE(wall.side, floor.side);
  EXPECT_NE(wall.side, PlaceOn(stretches, *scene, 0, 0, 0.75, Side::kBack).side);
  EXPECT_NEAR(wall.at, 0.75 * stretches.length(wall.side), 1e-15);
  EXPECT_NEAR(floor.at, 0.25 * stretches.length(floor.side), 1e-15);
  // A point on the corner belongs to what begins there.
  EXPECT_EQ(PlaceOn(stretches, *scene, 0, 1, 0).side, floor.side);
  EXPECT_FALSE(stretches.closed(floor.side));
}

TEST(StretchesTest, SmoothJointsDoNotPart) {
  SceneMaker maker;
  maker.Arc("circle", {{0, 0}, 0.5, 0.3, kFullTurn}).Arc("arc", {{2, 0}, 0.5, 0, 0.75 * kFullTurn});
  maker.Polyline("line", {{-1, -1}, {0, -1}, {3, -1}}, false);
  const auto scene = maker.PointProbe({0, 5}, {0, 1}).Build();
  const Stretches stretches(*scene);
  EXPECT_EQ(stretches.count(), 3u);
  const SidePlace first = PlaceOn(stretches, *scene, 0, 0, 0.5);
  const auto last = scene->curves()[0].element_count - 1;
  const SidePlace before = PlaceOn(stretches, *scene, 0, last, 0.5);
  EXPECT_TRUE(stretches.closed(first.side));
  EXPECT_EQ(first.side, before.side);
  EXPECT_NEAR(stretches.length(first.side), scene->curves()[0].length, 1e-14);
  EXPECT_NEAR(before.at - first.at, scene->curves()[0].length - scene->element(ElementId{0}).length, 1e-14);
  EXPECT_FALSE(stretches.closed(PlaceOn(stretches, *scene, 1, 0, 0.5).side));
  EXPECT_EQ(PlaceOn(stretches, *scene, 1, 0, 0.5).side, PlaceOn(stretches, *scene, 1, 2, 0.5).side);
  EXPECT_EQ(PlaceOn(stretches, *scene, 2, 0, 0.5).side, PlaceOn(stretches, *scene, 2, 1, 0.5).side);
}

TEST(StretchesTest, WallsPart) {
  SceneMaker maker;
  maker.Segment("floor", {0, 0}, {4, 0}).Segment("stands on it", {1, 0}, {1, 1}).Segment("crosses", {2, 1}, {2, -1});
  maker.Segment("hangs above", {3, 1}, {3, 0.01});
  const auto scene = maker.PointProbe({0, 5}, {0, 1}).Build();
  const Stretches stretches(*scene);
  const auto at = [&](double fraction) { return PlaceOn(stretches, *scene, 0, 0, fraction); };
  EXPECT_NE(at(0.2).side, at(0.3).side);
  EXPECT_NE(at(0.45).side, at(0.55).side);
  EXPECT_EQ(at(0.7).side, at(0.8).side);
  const double length = scene->curves()[0].length;
  EXPECT_NEAR(at(0.3).at, 0.05 * length, 1e-14);
  EXPECT_NEAR(stretches.length(at(0.8).side), 0.5 * length, 1e-14);
}

// The seam of a circle is no end, but what stands elsewhere on it is.
TEST(StretchesTest, AWallOpensACircle) {
  SceneMaker maker;
  maker.Arc("circle", {{0, 0}, 0.5, 0, kFullTurn})
      .Segment("wall", {0, 0.5}, {0, 2})
      .Segment("other", {0, -0.5}, {0, -2});
  const auto scene = maker.PointProbe({0, 5}, {0, 1}).Build();
  const Stretches stretches(*scene);
  const auto last = scene->curves()[0].element_count - 1;
  const SidePlace first = PlaceOn(stretches, *scene, 0, 0, 0.1), before = PlaceOn(stretches, *scene, 0, last, 0.9);
  EXPECT_EQ(first.side, before.side);
  EXPECT_FALSE(stretches.closed(first.side));
  EXPECT_NEAR(stretches.length(first.side), 0.5 * scene->curves()[0].length, 1e-13);
  EXPECT_NEAR(first.at - before.at, 0.2 * scene->element(ElementId{0}).length, 1e-13);
}

TEST(StretchesTest, ABezierIsOneStretch) {
  const auto scene = SceneMaker().Bezier("leaf", {{0, 0}, {1, 2}, {2, -2}, {3, 0}}).Probe("leaf", 1).Build();
  const Stretches stretches(*scene);
  EXPECT_GT(scene->elements().size(), 20u);
  EXPECT_EQ(stretches.count(), 1u);
}

}  // namespace
}  // namespace flatlight
