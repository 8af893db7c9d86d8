// SPDX-License-Identifier: Apache-2.0
// Scenes that were lit wrongly once, each as small as it came out of the stress bench. What is true of them is told by
// a closed form, or by the oracle in 113 bits.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <optional>

#include "core/plane/exact/gather.h"
#include "core/plane/exact/sweep.h"
#include "core/scene/scene.h"
#include "tests/core/plane/exact/oracle.h"
#include "tests/core/plane/exact/test_scenes.h"

namespace flatlight {
namespace {

// One point in the middle between two fractions of a curve's length.
SceneDescription& Probe(SceneDescription& scene, std::size_t curve, double from, double to, Side side) {
  AddProbe(scene, curve, 1, side);
  scene.probes.back().from = from, scene.probes.back().to = to;
  return scene;
}

SceneDescription& Probe(SceneDescription& scene, Point2 position, Vector2 normal) {
  ProbeDescription probe;
  probe.name = "free";
  probe.points.push_back({position, normal});
  scene.probes.push_back(probe);
  return scene;
}

WorldValue ValueOf(const SceneDescription& scene) { return Solve(*Build(scene), 0)[0]; }

// Of the only point, by the oracle.
std::optional<OracleValue> TruthOf(const SceneDescription& scene) {
  const Oracle oracle(scene);
  const ProbeDescription& probe = scene.probes[0];
  if (!probe.curve) return oracle.AtPoint(probe.points[0].position, probe.points[0].normal);
  for (std::size_t i = 0; i < scene.curves.size(); ++i) {
    if (scene.curves[i].name == *probe.curve)
      return oracle.OnCurve(i, 0.5 * (probe.from.value_or(0) + probe.to.value_or(1)), *probe.side);
  }
  return std::nullopt;
}

// Irradiance and both derivatives are within their bounds, but for the errors of the oracle's differences.
void ExpectTrue(const SceneDescription& scene, double widest_bound) {
  const WorldValue value = ValueOf(scene);
  const auto truth = TruthOf(scene);
  ASSERT_TRUE(truth);
  EXPECT_NEAR(value.irradiance, truth->irradiance, value.irradiance_error + 1e-15 * truth->size);
  EXPECT_NEAR(value.gradient, truth->gradient, value.gradient_error + 1e-13 * (1 + std::abs(truth->gradient)));
  EXPECT_NEAR(value.hessian, truth->hessian, value.hessian_error + 1e-10 * (1 + std::abs(truth->hessian)));
  EXPECT_GE(value.irradiance_error, 0);
  EXPECT_LE(value.irradiance_error, widest_bound);
}

// A lamp all but in line with the floor, one end above the horizon by more than coordinates are off, one not.
TEST(DegenerateTest, ALampInLineWithTheFloorEndsAtItsOwnHorizon) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{63948.13813619294, 13028.991924723046}, {65233.04653876298, 14008.692605405686}});
  AddCurve(scene, ArcDescription{{66615.9250094013, 14859.902445831318}, 161.57979535589038, -0.34856743087576847, 2});
  AddCurve(scene,
           SegmentDescription{{62663.232672724924, 12049.287389315201}, {62663.19054559566, 12049.342640376512}});
  AddCurve(scene, SegmentDescription{{65875.50074004801, 14498.542945747004}, {67802.86334390308, 15968.09396677096}},
           1);
  Probe(scene, 0, 0, 1, Side::kBack);
  const WorldValue value = ValueOf(scene);
  EXPECT_NEAR(value.irradiance, 0, 1e-14);
  EXPECT_GE(value.irradiance_error, value.irradiance);
}

TEST(DegenerateTest, ALampLowOnTheFloorIsNotLost) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene,
           SegmentDescription{{0.4027944778433378, -0.40815933280971917}, {0.391591649389857, -0.41881967900910755}});
  AddCurve(scene,
           SegmentDescription{{0.4016741949976699, -0.4092253674293219}, {0.40167422697902827, -0.40922540103814337}},
           1, true);
  AddCurve(scene,
           ArcDescription{{0.4086671331971243, -0.39189757238359035}, 0.007732178645907835, -1.9810020021231427, -2});
  AddCurve(scene,
           SegmentDescription{{0.38599023516311665, -0.4241498521088018}, {0.3691859924828956, -0.4401403714078844}});
  Probe(scene, 0, 0.75, 1, Side::kFront);
  EXPECT_NEAR(ValueOf(scene).irradiance, 7.49e-12, 0.01e-12);
  ExpectTrue(scene, 1e-14);
}

// Beyond the point the circle is above the floor, its dark inside away: it hides all there is.
TEST(DegenerateTest, AnArcWhoseCircleTouchesTheReceiver) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{-2, -1.5}, {2, -1.5}});
  AddCurve(scene, ArcDescription{{0.6018981936329884, -1.2088047378797697}, 0.29119526212023034, -0.5 * kPi, 1.3}, 1);
  Probe(scene, {0.6018981936329884, -1.5}, {0, 1});
  EXPECT_NEAR(ValueOf(scene).irradiance, 0, 1e-14);
}

TEST(DegenerateTest, WhatPokesThroughAShallowCrossingIsSeen) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{2, 1.5}, {-2, 1.5}});
  AddCurve(scene, SegmentDescription{{0.530149624322, -0.0594788564363}, {-0.755382758885, -0.0821842307963}});
  AddCurve(scene, SegmentDescription{{0.437766535947, -0.061110548894}, {-0.645649943414, -0.0802461040811}}, 1, true);
  Probe(scene, 0, 0, 1.0 / 3, Side::kFront);
  EXPECT_NEAR(ValueOf(scene).irradiance, 5.547e-5, 0.001e-5);
  ExpectTrue(scene, 1e-5);
}

TEST(DegenerateTest, CirclesThatTouchCrossToTheRootOfRounding) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, ArcDescription{{1.016681494, -0.7954991169}, 0.4957682087, 2.109092578, -6.283185307}, 1, true);
  AddCurve(scene, ArcDescription{{0.6522378387, -0.3086865647}, 0.1123482597, -1.867376134, 6.283185307});
  Probe(scene, 0, 0, 1, Side::kBack);
  ExpectTrue(scene, 1e-6);
}

TEST(DegenerateTest, AFarLampBesideANearEdge) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{2, 2}, {-2, 2}}, 1);
  AddCurve(scene, SegmentDescription{{0.8, -0.05}, {0.804028483363, -0.04775931626461274}}, 1.006013217669341, true);
  AddCurve(scene, SegmentDescription{{0.800733975572249, -0.06}, {0.7981164994455591, -0.060624968}});
  Probe(scene, 2, 0, 1, Side::kBack);
  ExpectTrue(scene, 1e-13);
}

TEST(DegenerateTest, APointOnThePartOfACircleThatTheArcLeavesOut) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, ArcDescription{{0, 0.25}, 0.125, 3.142, 3.142}, 1);
  Probe(scene, {0, 0.375}, {1, -2});
  ExpectTrue(scene, 1e-13);
}

// Just beyond its foot the dome hides what lies behind, upright.
TEST(DegenerateTest, ADomeWhoseFootIsTheProbePoint) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{-2, 0}, {2, 0}});
  AddCurve(scene, ArcDescription{{-1, 0}, 1, 0, kPi});
  AddCurve(scene, ArcDescription{{0, 0}, 9, 0, 2 * kPi}, 1);
  Probe(scene, 0, 0, 1, Side::kFront);
  const WorldValue value = ValueOf(scene);
  EXPECT_NEAR(value.irradiance, 1, value.irradiance_error);
  EXPECT_LE(value.irradiance_error, 1e-13);
}

TEST(DegenerateTest, TinyCirclesThatCrossFarAway) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{-2, -1.5}, {2, -1.5}});
  AddCurve(scene, ArcDescription{{-0.8181399514, -0.8256755802}, 3.806613104e-09, -2.165676754, 5.865602588});
  AddCurve(scene, ArcDescription{{-0.8181399528, -0.8256755813}, 5.295183637e-09, 0.3643974757, -5.799669582}, 1);
  Probe(scene, {0.1902811639, 0.3821628386}, {-0.7916236676, -0.6110089761});
  const WorldValue value = ValueOf(scene);
  EXPECT_NEAR(value.irradiance, 3.599078e-9, 1e-14);
  EXPECT_LE(value.irradiance_error, 1e-12);
}

TEST(DegenerateTest, AReceiverOnAShortArc) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, ArcDescription{{-0.247, -0.464}, 0.202, -4.62, -6.28});
  AddCurve(scene, ArcDescription{{-0.312, 0.432}, 0.698, -2.04, 6.28}, 1, true);
  AddCurve(scene, ArcDescription{{-0.167, -0.3}, 0.334, 0.205, 2.75e-07});
  Probe(scene, 2, 0, 0.5, Side::kFront);
  // By 50 digits; the oracle finds events all around a receiver that short.
  const WorldValue value = ValueOf(scene);
  EXPECT_NEAR(value.irradiance, 0.870808395274814859, value.irradiance_error);
  EXPECT_LE(value.irradiance_error, 1e-12);
}

// To the rounding of its coordinates a lamp goes through the receiver, upright: beyond it all behind is lamp.
TEST(DegenerateTest, ALampThroughTheReceiverFarAway) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene,
           SegmentDescription{{-114.18262706827309, 760.957048501771}, {-114.18280818043014, 760.9537544634956}});
  AddCurve(scene,
           SegmentDescription{{-114.18029237368421, 760.9544421389467}, {-114.18523343109756, 760.9547138071822}}, 1);
  Probe(scene, 0, 0.5, 1, Side::kFront);
  EXPECT_NEAR(ValueOf(scene).irradiance, 1, 1e-9);
}

// All that it sees is lamp.
TEST(DegenerateTest, TheEndOfAnArcIsTheProbePoint) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, ArcDescription{{0.2, 0}, 0.1, 5, -6});
  AddCurve(scene, SegmentDescription{{-0.9, -0.9}, {-0.9, 0.1}});
  AddCurve(scene, ArcDescription{{-1, -0.9}, 0.1, 6, -6}, 1);
  Probe(scene, {-0.9, -0.9}, {-1, 0});
  EXPECT_NEAR(ValueOf(scene).irradiance, 2, 1e-13);
}

// A free point that faces all but along a wall is on that side of it that its normal tells, and so with the lamp that
// crosses the wall there. The lamp then fills what lies between its own direction and the horizon.
TEST(DegenerateTest, AFreePointWhereALampCrossesTheWallThatItFacesAlong) {
  const Point2 lamp_a{0.0184255319894, -0.601038436414}, lamp_b{0.194320344726, -1.24950685483};
  const Vector2 normal = Normalized(Vector2{0.74, -0.68}), tangent = Right(normal);
  SceneDescription scene = EmptyScene();
  AddCurve(scene,
           SegmentDescription{{0.2863561296680723, -1.0453074970757064}, {-0.3584770878711364, -0.4550037358320174}});
  AddCurve(scene, SegmentDescription{lamp_a, lamp_b}, 1);
  Probe(scene, {0.09023280075144324, -0.8657690744601254}, normal);
  EXPECT_NEAR(ValueOf(scene).irradiance, 1 - Dot(Normalized(lamp_b - lamp_a), tangent), 1e-9);
}

// The same of a lamp above, as the scene is turned: whatever rounding does to the point's place.
TEST(DegenerateTest, AFreePointThatFacesAllButAlongAWallIsOnOneSideOfIt) {
  const Vector2 along = Normalized(Vector2{1, 0.3});
  for (const double tilt : {1e-2, 3e-3, 1e-3, -1e-3, 1e-5, -1e-7}) {
    for (int turn = 0; turn < 50; ++turn) {
      const Vector2 turned{std::cos(0.1 * turn), std::sin(0.1 * turn)};
      const auto at = [&](double x, double y) { return Point2{} + x * turned + y * Left(turned); };
      SceneDescription scene = EmptyScene();
      const Point2 a = at(-0.3 * along.x, -0.3 * along.y), b = at(0.8 * along.x, 0.8 * along.y);
      AddCurve(scene, SegmentDescription{a, b}, 1);
      const Vector2 facing = Normalized(b - a);
      // Seen on the wall's left, its front, alone: from the wall's direction to the horizon.
      const Vector2 normal = Normalized(facing + tilt * Left(facing));
      Probe(scene, a + 0.4 * (b - a), normal);
      const double seen = tilt > 0 ? 1 - std::abs(Cross(facing, normal)) : 0;
      EXPECT_NEAR(ValueOf(scene).irradiance, seen, 1e-6) << tilt << " " << turn;
    }
  }
}

// The receiver touches a circle from below that shines outward: behind its upright tangent all is lamp, as the root of
// the way onward.
TEST(DegenerateTest, BoundsOfACircleThatTouchesAnArcAreNotNegative) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, ArcDescription{{0.125, 0.625}, 0.5, -1.5 * kPi, -2 * kPi}, 1);
  AddCurve(scene, ArcDescription{{-0.125, 0.125}, 0.25, -1.5 * kPi, -3.14159265359});
  Probe(scene, 1, 0, 1, Side::kBack);
  const WorldValue value = ValueOf(scene);
  EXPECT_GE(value.irradiance_error, 0);
  EXPECT_NEAR(value.irradiance, 1, 1e-6);
}

TEST(DegenerateTest, AReceiverOfAFewAtomsGetsNoMoreThanAllLight) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, ArcDescription{{0.259162, 0.831409}, 0.30587, 2.5053, 5.39576}, 1);
  AddCurve(scene, ArcDescription{{0.467787, 0.260609}, 0.86197, -4.25085, -8.27883e-09});
  Probe(scene, 1, 0, 0.5, Side::kBack);
  const WorldValue value = ValueOf(scene);
  EXPECT_NEAR(value.irradiance, 2, value.irradiance_error);
  EXPECT_LE(value.irradiance_error, 1e-6);
}

TEST(DegenerateTest, DerivativesAtAShallowCrossing) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{-0.6957, -0.3871}, {0.6117, 0.7234}});
  AddCurve(scene, SegmentDescription{{-0.5557, -0.2684}, {0.8273, 0.9069}}, 1);
  Probe(scene, {-0.1996, 0.03447}, {0.5591, 0.8291});
  ExpectTrue(scene, 1e-10);
}

TEST(DegenerateTest, ATinyCircleOnAWallFarAway) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{-2, -1.5}, {2, -1.5}});
  AddCurve(scene, SegmentDescription{{0.3601351706499302, -0.525482314611}, {0.3601352364333666, -0.5254823559137611}});
  AddCurve(scene, ArcDescription{{0.36013515, -0.52548232}, 2.4e-08, -2, -5}, 1);
  Probe(scene, 0, 2.0 / 3, 1, Side::kFront);
  EXPECT_NEAR(ValueOf(scene).irradiance, 9.81e-9, 0.01e-9);
  ExpectTrue(scene, 1e-13);
}

TEST(DegenerateTest, ATinyCircleAndAWallThatTouchesIt) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{-2, -1.5}, {2, -1.5}});
  AddCurve(scene, ArcDescription{{-0.18542708, 0.33690684}, 1.133682e-09, 0.88762732, 3.9776773}, 1);
  AddCurve(scene, SegmentDescription{{-0.18542708, 0.33690684}, {-0.18542708, 0.33690685}});
  Probe(scene, 0, 0, 1, Side::kFront);
  ExpectTrue(scene, 1e-13);
}

// A point 2e-8 before the apex, where its own side of the hairpin and the other are 2e-15 apart: inside it sees nothing
// but the other, outside all but that.
TEST(DegenerateTest, APointInsideTheApexOfAHairpin) {
  for (const Side side : {Side::kFront, Side::kBack}) {
    SceneDescription scene = EmptyScene();
    AddCurve(scene,
             PolylineDescription{
                 {{-0.700860585, -0.2255476997}, {0.2505779863, -0.4325933116}, {-0.7008605598, -0.2255477869}}, false},
             1, true);
    Probe(scene, 0, 0, 1, side);
    const WorldValue value = ValueOf(scene);
    // But for the square of the angle.
    EXPECT_NEAR(value.irradiance, side == Side::kBack ? 2 : 0, value.irradiance_error + 5e-15);
    EXPECT_LE(value.irradiance_error, 1e-14);
  }
}

// Walls cross at the point, which faces along one of them: just beyond, along its tangent, that one hides all behind
// it, and the other lies along the tangent, or hides what is between itself and that way.
TEST(DegenerateTest, AFreePointAtACrossingFacesAlongOneOfTheWalls) {
  for (const double turn : {90.0, 60.0, 120.0, 30.0}) {
    const double angle = turn * kPi / 180;
    SceneDescription scene = EmptyScene();
    AddCurve(scene, ArcDescription{{0, 0}, 9, 0, 2 * kPi}, 1);
    AddCurve(scene, SegmentDescription{{0, -1}, {0, 1}});
    AddCurve(scene, SegmentDescription{Point2{-std::sin(angle), -std::cos(angle)}, {std::sin(angle), std::cos(angle)}});
    Probe(scene, {0, 0}, {0, 1});
    // The tangent is (1, 0): seen are the directions from the wall ahead to the other wall or to the horizon, those of
    // the side on which the tangent leaves both.
    const double seen = turn < 90 ? 1 - std::sin(angle) : 1;
    EXPECT_NEAR(ValueOf(scene).irradiance, seen, 1e-6) << turn;
  }
}

// Before the apex of a hairpin the mouth is closed by a lamp that crosses one side a little before its end: light ends
// where it crosses, in whatever order they are found.
TEST(DegenerateTest, TheEndOfAWallSeenAllButEdgeOnBehindALamp) {
  const SegmentDescription lamp{{-0.67714, -0.958565}, {0.951979, -0.772956}};
  const PolylineDescription hairpin{{{0.31947, -0.890937}, {0.591467, 0.665443}, {0.31947, -0.890938}}, false};
  for (const bool lamp_first : {true, false}) {
    SceneDescription scene = EmptyScene();
    if (lamp_first) AddCurve(scene, lamp, 1);
    AddCurve(scene, hairpin);
    if (!lamp_first) AddCurve(scene, lamp, 1);
    Probe(scene, lamp_first ? 1 : 0, 0, 1, Side::kBack);
    const WorldValue value = ValueOf(scene);
    // By 40 digits.
    EXPECT_NEAR(value.irradiance, 5.936138748e-15, value.irradiance_error);
    EXPECT_NEAR(value.gradient, 7.747468259e-15, 1e-23);
  }
}

// In line with a crossing, and with the end of a wall upon it, there is another end, far behind: light begins at the
// crossing, and moves with it.
TEST(DegenerateTest, AnEndInLineWithACrossingIsNotWhereLightBegins) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{2, 1.5}, {-2, 1.5}});
  AddCurve(scene, SegmentDescription{{-2, -2}, {2, -1.5}});
  AddCurve(scene,
           SegmentDescription{{0.4325642522503203, 0.8252406583854818}, {0.5707292836508524, 0.6710846168892833}}, 1);
  AddCurve(scene,
           SegmentDescription{{0.5031714593925872, 0.8381027934015324}, {0.48322394463087076, 0.28396302543438784}});
  AddCurve(scene, SegmentDescription{{0.5, 0.75}, {-0.2, 0.4}});
  Probe(scene, 0, 0, 1, Side::kFront);
  const WorldValue value = ValueOf(scene);
  // By differences in 60 digits.
  EXPECT_NEAR(value.irradiance, 0.015010902142157997, 1e-14);
  EXPECT_NEAR(value.gradient, -0.11620821, 1e-8);
}

// Walls through one point, in a room: all that is seen shines alike. Work grows as what is seen of them; of arcs, each
// of these is asked for crossings with all that lie in its direction.
double ComparisonsOfPencil(bool arcs, int walls) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, PolylineDescription{{{-2, -1.5}, {2, -1.5}, {2, 1.5}, {-2, 1.5}}, true}, 1);
  for (int i = 0; i < walls; ++i) {
    const double angle = kPi * (i + 0.37) / walls, reach = 0.6 + 0.2 * ((i * 7) % 11) / 11.0;
    const Vector2 along{std::cos(angle), std::sin(angle)};
    const Point2 middle{0.1, 0.2};
    if (arcs) {
      const double start = angle - 0.5 * kPi - 0.5 * reach;
      AddCurve(scene, ArcDescription{middle + Left(along), 1, start, reach}, 1, true);
    } else {
      AddCurve(scene, SegmentDescription{middle - reach * along, middle + 0.8 * reach * along}, 1, true);
    }
  }
  Probe(scene, {0.3, -1}, {0.2, 1});
  const WorldValue value = ValueOf(scene);
  EXPECT_NEAR(value.irradiance, 2, value.irradiance_error);
  const auto built = Build(scene);
  const Bvh bvh(*built);
  const Receiver& receiver = built->probes()[0].receivers[0];
  Gatherer gatherer(*built, bvh);
  gatherer.Gather(receiver);
  Sweep sweep(*built);
  sweep.Run(gatherer.PartsInDoubt(receiver), receiver);
  return sweep.comparisons();
}

TEST(DegenerateTest, WorkAmongThousandsThroughOnePointIsNotCubic) {
  for (const bool arcs : {false, true}) {
    const double few = ComparisonsOfPencil(arcs, 200), many = ComparisonsOfPencil(arcs, 400);
    EXPECT_GT(few, 200);
    EXPECT_LT(many, (arcs ? 5 : 3) * few) << arcs;
    EXPECT_LT(many, (arcs ? 8 * 400 : 20) * 400) << arcs;
  }
}

// Which of two edges comes first decides whether a strip of 1e-15 is lit: its gradient is in the bound.
TEST(DegenerateTest, AStripBesideASilhouetteAsNarrowAsRoundingIsInTheBound) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{-2, -1.5}, {2, -1.5}});
  AddCurve(scene, ArcDescription{{0.638969, -0.962088}, 1.8607e-09, -2.54716, -2.65976}, 1);
  ExpectTrue(Probe(scene, 0, 0.5, 1, Side::kFront), 1e-13);
}

// The arc ends on a circle, where that one's silhouette is: light begins at a place that stays, or at one that slides.
TEST(DegenerateTest, AnEndOnASilhouetteHasBothSecondDerivativesInItsBound) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, ArcDescription{{-0.5, 0.25}, 0.625, 0, -0.5 * kPi});
  AddCurve(scene, SegmentDescription{{0.5, 0.875}, {1.5, 0.875}});
  AddCurve(scene, ArcDescription{{0, -0.375}, 0.25, -0.5 * kPi, kPi}, 1, true);
  Probe(scene, 1, 0, 0.5, Side::kBack);
  const WorldValue value = ValueOf(scene);
  SceneDescription reversed = EmptyScene();
  AddCurve(reversed, ArcDescription{{-0.5, 0.25}, 0.625, -0.5 * kPi, 0.5 * kPi});
  AddCurve(reversed, SegmentDescription{{1.5, 0.875}, {0.5, 0.875}});
  AddCurve(reversed, ArcDescription{{0, -0.375}, 0.25, 0.5 * kPi, -kPi}, 1, true);
  const WorldValue other = ValueOf(Probe(reversed, 1, 0.5, 1, Side::kFront));
  EXPECT_NEAR(value.irradiance, other.irradiance, value.irradiance_error + other.irradiance_error);
  EXPECT_NEAR(value.gradient, -other.gradient, value.gradient_error + other.gradient_error);
  EXPECT_NEAR(value.hessian, other.hessian, value.hessian_error + other.hessian_error);
  EXPECT_GT(std::abs(value.hessian - other.hessian), 0.16);  // Either is one outcome.
  EXPECT_LT(value.gradient_error, 1e-11);
  EXPECT_LT(value.irradiance_error, 1e-13);
}

// Some 1e-14 are missing from a full circle, and are seen from inside it, where coordinates cannot tell.
TEST(DegenerateTest, LightThroughTheGapOfACircleThatAllButClosesIsInTheBound) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, ArcDescription{{-0.9971433521, -0.2990337993}, 0.5059698683, -1.67344674, 6.282181311}, 1, true);
  AddCurve(scene, ArcDescription{{-0.6823140823, -0.9503495096}, 5.694423476e-05, 1.630401518, 6.283185307});
  ExpectTrue(Probe(scene, 1, 0.5, 1, Side::kFront), 1e-9);
  EXPECT_GT(TruthOf(scene)->irradiance, 6e-11);
}

// As long as its coordinates are accurate: nobody can tell which side is seen.
TEST(DegenerateTest, ALampAsShortAsRoundingIsInTheBound) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, ArcDescription{{-8e-05, 0.002}, 1, 0.1, 4});
  AddCurve(scene, SegmentDescription{{0.4303410561744757, 0.731622686590037}, {0.43034105617447593, 0.731622686590037}},
           1);
  ExpectTrue(Probe(scene, 0, 0, 0.5, Side::kFront), 1e-13);
  EXPECT_GT(TruthOf(scene)->irradiance, 1e-15);
}

// Two walls that all but meet, near the point, and a lamp behind: what their slit may let through changes fast as the
// point moves, and is all that the bounds hold.
TEST(DegenerateTest, ASlitAsNarrowAsRoundingHasItsDerivativesInTheBounds) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{-1, 1e-4}, {0.3, 1e-4}});
  AddCurve(scene, SegmentDescription{{0.3 + 0x1p-51, 1e-4}, {1, 1e-4}});
  AddCurve(scene, SegmentDescription{{1, 1}, {-1, 1}}, 1);
  const WorldValue value = ValueOf(Probe(scene, {0.30005, 0}, {0, 1}));
  // As seen from the point its width, some 4e-16, times 1/distance^2; and by another 1/distance.
  const double q = 1 / std::hypot(5e-5, 1e-4), width = 0x1p-51;
  EXPECT_GT(value.irradiance_error, width * q * 0.8);
  EXPECT_GT(value.gradient_error, width * q * q * 0.8);
  EXPECT_GT(value.hessian_error, width * q * q * q * 0.8);
  EXPECT_LT(value.irradiance_error, 1e-10);
  EXPECT_LT(value.gradient_error, 1e-6);
  EXPECT_LT(value.hessian_error, 1e-1);
}

// A receiver of a few atoms, hollow: its own end is so near that its direction and those of the lamp's ends are one to
// the accuracy of coordinates. What it hides if it is is in the bound.
TEST(DegenerateTest, ALampNearTheHorizonOfAReceiverOfAFewAtoms) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, ArcDescription{{-0.107, 0.853}, 3.48e-05, -6.62, -1e-09});
  AddCurve(scene, SegmentDescription{{-0.64, -0.58}, {-0.64, -0.581}}, 1);
  const WorldValue value = ValueOf(Probe(scene, 0, 0, 1, Side::kBack));
  // The sine of the lamp's ends; its own arc hides nothing so high.
  const Point2 at{-0.107 + 3.48e-05 * std::cos(-6.62), 0.853 + 3.48e-05 * std::sin(-6.62)};
  const auto sine = [&](Point2 p) {
    const Vector2 to = p - at;
    return Cross(Vector2{std::cos(-6.62), std::sin(-6.62)}, to) / Length(to);
  };
  EXPECT_NEAR(value.irradiance, std::abs(sine({-0.64, -0.58}) - sine({-0.64, -0.581})), value.irradiance_error);
  EXPECT_LT(value.irradiance_error, 1e-3);
}

// Two walls that run in opposite directions, 7e-15 apart at one end: not one over the other, though one's other end is
// on the line of the other.
TEST(DegenerateTest, WallsInOppositeDirectionsAreTwoIfTheyAreApart) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene,
           SegmentDescription{{-0.39717349574242733, -0.21420116134490885}, {-0.607816047398, -0.20921833357503672}});
  AddCurve(scene,
           SegmentDescription{{-0.6078160473976885, -0.20921833357503672}, {-0.5656875370666362, -0.21021489912901115}},
           1);
  AddCurve(scene, SegmentDescription{{0.2, 0.4}, {-0.5, 0.2}});
  ExpectTrue(Probe(scene, 2, 0, 1.0 / 3, Side::kFront), 1e-13);
  EXPECT_GT(TruthOf(scene)->irradiance, 0.01);
}

}  // namespace
}  // namespace flatlight
