// SPDX-License-Identifier: Apache-2.0
// Where curves and points come to lie: nothing rounds that need not, and points lie on the curve that goes on there.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/math/tolerances.h"
#include "core/scene/element_frame.h"
#include "core/scene/scene.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

constexpr double kPi = std::numbers::pi;

Vector2 WorldChord(const Scene& scene, std::size_t element) {
  const Element& e = scene.elements()[element];
  return scene.frame().scale * (e.b - e.a);
}

// A short wall keeps its direction, bit for bit, whatever else the scene holds and wherever it lies.
TEST(PlacingTest, ShiftsRoundNoCoordinate) {
  for (const double shift : {0.0, 0.3, 1.5, 2.9, 700.0}) {
    const Point2 a{shift - 0.49776928, shift - 0.84865334}, b{shift - 0.49776927, shift - 0.84865334};
    SceneMaker maker;
    maker.Segment("short", a, b);
    maker.Segment("long", {shift - 0.7, shift - 0.9}, {shift + 0.9, shift + 0.3}, {.radiance = {1}});
    maker.Probe("short", 1);
    const auto scene = maker.Build();
    EXPECT_EQ(WorldChord(*scene, 0), b - a) << shift;
    EXPECT_EQ(scene->coordinate_error(), 2 * kUnitRoundoff) << shift;
  }
}

// The circle is written about a: then b lies on it, and the arc bulges, however large the radius is.
TEST(PlacingTest, WideArcsKeepTheirShape) {
  for (const double radius : {3.0, 1e5, 7e8}) {
    const double middle = 1.8, half = 0.5 / radius;
    const Point2 center = Point2{} - radius * Vector2{std::cos(middle), std::sin(middle)};
    SceneMaker maker;
    maker.Arc("arc", {center, radius, middle - half, 2 * half});
    maker.PointProbe({0, 3}, {0, 1});
    const auto scene = maker.Build();
    for (const Element& arc : scene->elements()) {
      const Vector2 chord = arc.b - arc.a;
      EXPECT_NEAR(Dot(chord, arc.radial_a) + LengthSquared(chord) / (2 * arc.radius), 0, 8 * kUnitRoundoff) << radius;
    }
  }
}

TEST(PlacingTest, ArcsOfOneCircleShareACarrierWhateverTheirCurves) {
  SceneMaker maker;
  maker.Arc("one", {{0.25, 0.5}, 0.75, 0, 2});
  maker.Arc("other", {{0.25, 0.5}, 0.75, 3, -1});
  maker.Arc("smaller", {{0.25, 0.5}, 0.5, 3, -1});
  maker.PointProbe({0, 0}, {0, 1});
  const auto scene = maker.Build();
  ASSERT_EQ(scene->elements().size(), 4u);
  EXPECT_EQ(scene->elements()[0].carrier, scene->elements()[2].carrier);
  EXPECT_NE(scene->elements()[0].carrier, scene->elements()[3].carrier);
}

// Along the tangent (normal.y, -normal.x), in whatever order the two are listed.
TEST(PlacingTest, AFreePointWhereTwoPiecesMeetLiesOnTheOneThatGoesOn) {
  for (const bool left_first : {true, false}) {
    for (const double normal : {1.0, -1.0}) {
      SceneMaker maker;
      if (left_first) maker.Segment("left", {-1, 0}, {0.3, 0});
      maker.Segment("right", {0.3, 0}, {1, 0});
      if (!left_first) maker.Segment("left", {-1, 0}, {0.3, 0});
      maker.PointProbe({0.3, 0}, {0, normal});
      const auto scene = maker.Build();
      const ElementId element = scene->probes()[0].receivers[0].element;
      ASSERT_NE(element, ElementId::kNone);
      EXPECT_EQ(scene->curve_of(element).name, normal > 0 ? "right" : "left") << left_first;
    }
  }
}

// A covered piece's points lie on the cover, although far from the origin both are known to few digits.
TEST(PlacingTest, PointsOfACoveredPieceLieOnTheCoverFarAwayToo) {
  for (const double far : {0.0, 1e3, 1e6}) {
    const Point2 a{far - 0.556971397818, far + 0.00760865450222}, b{far - 0.249819680871, far - 0.17223901922};
    SceneMaker maker;
    maker.Segment("cover", a, b);
    maker.Segment("covered", a, a + 0.3 * (b - a));
    maker.Segment("lamp", {far + 1, far + 1}, {far - 1, far + 1}, {.radiance = {1}});
    maker.Probe("covered", 3);
    const auto scene = maker.Build();
    for (const Receiver& receiver : scene->probes()[0].receivers) EXPECT_NE(receiver.element, ElementId::kNone) << far;
  }
}

// A point on a curve that it does not face is lifted off it: beyond all doubt, wherever the scene is.
TEST(PlacingTest, LiftedPointsAreClearOfTheirCurve) {
  for (const double far : {0.0, 512.0, 1e6}) {
    SceneMaker maker;
    maker.Segment("wall", {far - 1, 0}, {far + 1, 0});
    maker.PointProbe({far, 0}, {1, 2});
    const auto scene = maker.Build();
    EXPECT_GT(DistanceTo(scene->elements()[0], scene->probes()[0].receivers[0].position), 64 * scene->touch_distance());
  }
}

TEST(PlacingTest, TheDistanceToAnArcIsNotThatToItsChord) {
  SceneMaker maker;
  maker.Arc("quarter", {{0, 0}, 1, 0, kPi / 2});
  maker.PointProbe({0.5, 0.5}, {1, 0});  // On the chord: not on the arc, so not lifted.
  const auto scene = maker.Build();
  const Element& arc = scene->elements()[0];
  EXPECT_EQ(scene->probes()[0].receivers[0].position, (Point2{0.5, 0.5}));
  EXPECT_GT(DistanceTo(arc, {0.5, 0.5}), 0.5 * (1 - std::sqrt(0.5)));
  EXPECT_NEAR(DistanceTo(arc, {0.7, 0.7}), 1 - std::sqrt(0.98), 1e-4);
  EXPECT_NEAR(DistanceTo(arc, {0.9, -0.05}), std::hypot(0.1, 0.05), 1e-15);      // Beside the end.
  EXPECT_NEAR(DistanceTo(arc, {0.93, 0.02}), 1 - std::hypot(0.93, 0.02), 3e-3);  // On the empty side, before the end.
}

}  // namespace
}  // namespace flatlight
