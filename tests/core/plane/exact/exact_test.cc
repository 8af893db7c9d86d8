// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/exact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "core/plane/exact/edge.h"
#include "core/plane/exact/light_solver.h"
#include "core/plane/ray_caster.h"
#include "core/scene/scene.h"
#include "tests/core/plane/exact/oracle.h"
#include "tests/core/plane/exact/test_scenes.h"

namespace flatlight {
namespace {

// Compares every point of every probe of the scene with the oracle.
struct Agreement {
  int compared = 0;
  int skipped = 0;
};

void Compare(const SceneDescription& description, Agreement& agreement, const std::string& what) {
  const auto scene = Build(description);
  ASSERT_TRUE(scene);
  const Oracle oracle(description);
  const double extent = scene->frame().scale;
  for (std::size_t p = 0; p < description.probes.size(); ++p) {
    const ProbeDescription& probe = description.probes[p];
    const std::vector<WorldValue> values = Solve(*scene, p);
    for (std::size_t i = 0; i < values.size(); ++i) {
      std::optional<OracleValue> truth;
      if (probe.curve) {
        truth = oracle.OnCurve(std::stoul(probe.curve->substr(1)), (static_cast<double>(i) + 0.5) / *probe.count,
                               *probe.side);
      } else {
        truth = oracle.AtPoint(probe.points[i].position, probe.points[i].normal);
      }
      if (!truth) {
        ++agreement.skipped;
        continue;
      }
      ++agreement.compared;
      const WorldValue& v = values[i];
      const std::string where = what + ", probe " + std::to_string(p) + ", point " + std::to_string(i);
      // The differences' own error: see the oracle's agreement limits.
      EXPECT_LE(std::abs(v.irradiance - truth->irradiance), v.irradiance_error + 1e-15 * truth->size) << where;
      EXPECT_LE(std::abs(v.gradient - truth->gradient),
                v.gradient_error + 1e-13 * (truth->size / extent + std::abs(truth->gradient)))
          << where << " gradient " << v.gradient << " truth " << truth->gradient;
      EXPECT_LE(std::abs(v.hessian - truth->hessian),
                v.hessian_error + 1e-10 * (truth->size / extent / extent + std::abs(truth->hessian)))
          << where << " hessian " << v.hessian << " truth " << truth->hessian;
    }
  }
}

TEST(ExactTest, UnitLight) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{0, 0}, {1, 0}});
  AddCurve(scene, SegmentDescription{{1, 1}, {0, 1}}, 2);
  AddProbe(scene, 0, 10);
  const auto values = Solve(*Build(scene), 0);
  for (int i = 0; i < 10; ++i) {
    const double x = (i + 0.5) / 10;
    EXPECT_NEAR(values[static_cast<std::size_t>(i)].irradiance,
                2 * ((1 - x) / std::hypot(1 - x, 1) + x / std::hypot(x, 1)), 4e-15);
  }
}

TEST(ExactTest, BlockerOfThePaper) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{0, 0}, {1, 0}});
  AddCurve(scene, SegmentDescription{{1, 1}, {0, 1}}, 1);
  AddCurve(scene, SegmentDescription{{0.5, 0.5}, {1.2, 0.5}});
  ProbeDescription probe;
  probe.name = "p";
  probe.points.push_back({{0.3, 0}, {0, 1}});
  scene.probes.push_back(probe);
  const auto value = Solve(*Build(scene), 0)[0];
  EXPECT_NEAR(value.irradiance, 0.6587, 5e-5);
  EXPECT_NEAR(value.gradient, -0.7221, 5e-5);
  EXPECT_NEAR(value.hessian, -4.0376, 5e-5);
  EXPECT_LT(value.irradiance_error, 1e-14);
  EXPECT_LT(value.hessian_error, 1e-12);
}

// The share of the light leaving one segment that reaches another, by strings drawn between their ends (Hottel 1954),
// against the mean irradiance; both ways round.
TEST(ExactTest, CrossedStrings) {
  const Point2 a{0, 0}, b{1.5, 0.2}, c{1.2, 1.1}, d{-0.3, 0.8};
  const double strings = (Length(d - b) + Length(c - a)) - (Length(d - a) + Length(c - b));
  constexpr std::uint32_t kPoints = 4000;
  for (const bool from_ab : {false, true}) {
    SceneDescription scene = EmptyScene();
    AddCurve(scene, SegmentDescription{a, b}, from_ab ? 1 : 0);
    AddCurve(scene, SegmentDescription{c, d}, from_ab ? 0 : 1);
    AddProbe(scene, from_ab ? 1 : 0, kPoints);
    double mean = 0;
    for (const WorldValue& value : Solve(*Build(scene), 0)) mean += value.irradiance / kPoints;
    const double length = from_ab ? Length(d - c) : Length(b - a);
    // E = 2 L F; the midpoint rule errs by h^2/24 times the difference of the end slopes.
    EXPECT_NEAR(mean * length, strings, 1e-7) << from_ab;
  }
}

TEST(ExactTest, FullDiscFollowsOneOverDistance) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{-1, 0}, {1, 0}});
  AddCurve(scene, ArcDescription{{0.25, 2}, 0.5, 0.3, -2 * kPi}, 3);  // Clockwise: it shines outward.
  AddProbe(scene, 0, 7);
  const auto values = Solve(*Build(scene), 0);
  for (std::size_t i = 0; i < 7; ++i) {
    const double x = -1 + (static_cast<double>(i) + 0.5) / 7 * 2;
    const double distance = std::hypot(0.25 - x, 2);
    EXPECT_NEAR(values[i].irradiance, 2 * 3 * (2 / distance) * 0.5 / distance, 1e-14);
  }
}

TEST(ExactTest, InsideAnEmittingCircleEveryPointGetsTwiceTheRadiance) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, ArcDescription{{5, -3}, 2, 1, 2 * kPi}, 1.5);
  AddProbe(scene, 0, 50);
  for (const WorldValue& value : Solve(*Build(scene), 0)) {
    EXPECT_NEAR(value.irradiance, 3, 1e-14);
    EXPECT_NEAR(value.gradient, 0, 1e-13);
    EXPECT_NEAR(value.hessian, 0, 1e-13);
  }
}

TEST(ExactTest, BackProbeAndTurnedFreePointAgreeUpToTheTangent) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{0, 0}, {1, 0}});
  AddCurve(scene, SegmentDescription{{0.2, -1}, {0.9, -1.5}}, 1);
  AddProbe(scene, 0, 1, Side::kBack);
  ProbeDescription free;
  free.name = "free";
  free.points.push_back({{0.5, 0}, {0, -1}});
  scene.probes.push_back(free);
  const auto built = Build(scene);
  const auto back = Solve(*built, 0)[0], turned = Solve(*built, 1)[0];
  EXPECT_GT(back.irradiance, 0.1);
  EXPECT_DOUBLE_EQ(back.irradiance, turned.irradiance);
  EXPECT_NEAR(back.gradient, -turned.gradient, 1e-14);
  EXPECT_NEAR(back.hessian, turned.hessian, 1e-13);
}

// A wall seen edge-on: exactly above the receiver. Toward increasing arc length its right face comes into view.
TEST(ExactTest, DerivativesAtAnEventAreThoseBeyondIt) {
  for (const double radiance : {0.0, 1.0}) {
    SceneDescription scene = EmptyScene();
    AddCurve(scene, SegmentDescription{{0, 0}, {1, 0}});
    AddCurve(scene, SegmentDescription{{0.5, 0.6}, {0.5, 0.3}}, radiance);  // Front to the right of it (+x).
    AddCurve(scene, SegmentDescription{{0.9, 1}, {0.1, 1}}, 0.7);
    const auto at = [&](double x) {
      ProbeDescription probe;
      probe.name = "p";
      probe.points.push_back({{x, 0}, {0, 1}});
      scene.probes.assign(1, probe);
      return Solve(*Build(scene), 0)[0];
    };
    const double step = 1e-6;
    const WorldValue here = at(0.5), beyond = at(0.5 + step), before = at(0.5 - step);
    EXPECT_NEAR(here.gradient, beyond.gradient - step * beyond.hessian, 1e-9);
    EXPECT_NEAR(here.hessian, beyond.hessian, 1e-3);
    EXPECT_GT(std::abs(here.gradient - before.gradient), 0.5);
  }
}

// What is known one-sidedly: the value at a point is the limit of the values beyond it.
void ExpectOneSided(const SceneDescription& description, const std::string& what) {
  constexpr double kStep = 1e-7;
  SceneDescription moved = description;
  for (ProbeDescription& probe : moved.probes) {
    for (ProbePointDescription& point : probe.points) point.position = point.position + kStep * Right(point.normal);
  }
  const auto here = Build(description), there = Build(moved);
  for (std::size_t p = 0; p < description.probes.size(); ++p) {
    const auto at = Solve(*here, p), beyond = Solve(*there, p);
    for (std::size_t i = 0; i < at.size(); ++i) {
      const Point2 x = description.probes[p].points[i].position;
      const std::string where = what + ", point " + std::to_string(x.x) + " " + std::to_string(x.y) + " normal " +
                                std::to_string(description.probes[p].points[i].normal.x) + " " +
                                std::to_string(description.probes[p].points[i].normal.y);
      // Steps are 1/8 or more from every vertex that is not in line with the point: third derivatives stay below 1e5.
      EXPECT_NEAR(at[i].irradiance, beyond[i].irradiance - kStep * beyond[i].gradient, 1e-11) << where;
      EXPECT_NEAR(at[i].gradient, beyond[i].gradient - kStep * beyond[i].hessian, 1e-7) << where;
      EXPECT_NEAR(at[i].hessian, beyond[i].hessian, 0.05) << where;
    }
  }
}

// Boxes and walls on a grid, seen from the grid: nearly every point lies on several events at once.
TEST(ExactTest, GridScenesAreOneSidedAtEveryEvent) {
  std::mt19937_64 random(3);
  for (int round = 0; round < 300; ++round) {
    SceneDescription scene = EmptyScene();
    const auto grid = [&] { return static_cast<double>(random() % 17) / 8 - 1; };
    // Above y = 0, in boxes that touch at sides and corners but do not overlap.
    for (int box = 0; box < 5; ++box) {
      const double x = static_cast<double>(box) * 0.375 - 1;
      const double w = 0.125 * static_cast<double>(1 + random() % 3), y = 0.125 * static_cast<double>(1 + random() % 5),
                   h = 0.125 * static_cast<double>(1 + random() % 3);
      AddCurve(scene, PolylineDescription{{{x, y}, {x, y + h}, {x + w, y + h}, {x + w, y}}, true},
               random() % 2 == 0 ? 1.0 : 0, true);
    }
    AddCurve(scene, SegmentDescription{{1, 1.5}, {-1, 1.5}}, 0.7);
    ProbeDescription probe;
    probe.name = "p";
    for (int i = 0; i < 8; ++i) probe.points.push_back({{grid(), 0}, {0, 1}});
    scene.probes.push_back(probe);
    ExpectOneSided(scene, "round " + std::to_string(round));
    if (HasFailure()) return;
  }
}

TEST(ExactTest, AWallSeenEdgeOnThatCrossesTheLampHidesASliver) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{2, 1.5}, {-2, 1.5}}, 1);
  AddCurve(scene, SegmentDescription{{0, 1}, {0, 2}});
  scene = WithFreePoint(scene, {0, 0});
  ExpectOneSided(scene, "edge-on");
  EXPECT_NEAR(Solve(*Build(scene), 0)[0].gradient, -1.0 / 3, 1e-14);
}

TEST(ExactTest, AHiddenEndBehindACrossingIsNotItsBreak) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{1, 1}, {-1, 1}}, 1, true);
  AddCurve(scene, SegmentDescription{{0.5, 0.5}, {0.5, 1.5}});
  AddCurve(scene, SegmentDescription{{1, 2}, {2, 2}});  // Its end lies beyond the crossing at (0.5, 1), seen from here.
  ExpectOneSided(WithFreePoint(scene, {0, 0}), "hidden end");
}

TEST(ExactTest, TheTangentAtAnArcsEndIsAnEventAndAtAJointIsNot) {
  SceneDescription half = EmptyScene();
  AddCurve(half, ArcDescription{{-0.5, 1}, 0.5, 0, kPi}, 1, true);  // Ends at (0, 1), upright.
  ExpectOneSided(WithFreePoint(half, {0, 0}), "end");
  // A full circle is cut into arcs, one joint straight above: nothing happens there.
  SceneDescription disc = EmptyScene();
  AddCurve(disc, ArcDescription{{-0.5, 1}, 0.5, 0, -2 * kPi}, 1);
  for (const double x : {0.0, 1e-9, -1e-9, 1e-8, -1e-8}) {
    const WorldValue here = Solve(*Build(WithFreePoint(disc, {x, 0})), 0)[0];
    const WorldValue aside = Solve(*Build(WithFreePoint(disc, {x + 1e-3, 0})), 0)[0];
    EXPECT_NEAR(here.gradient, aside.gradient, 5e-3) << x;
    EXPECT_NEAR(here.hessian, aside.hessian, 2e-2) << x;
  }
}

TEST(ExactTest, TinyDiscsAreRound) {
  for (const double radius : {1e-3, 1e-6, 1e-8, 1e-10}) {
    SceneDescription scene = EmptyScene();
    AddCurve(scene, SegmentDescription{{-2, 0}, {2, 0}});
    AddCurve(scene, ArcDescription{{0, 1}, radius, 0, -2 * kPi}, 1 / radius);
    AddProbe(scene, 0, 2);  // At x = -1 and 1: E = 2 L R cos/D = 1.
    for (const WorldValue& value : Solve(*Build(scene), 0)) {
      EXPECT_NEAR(value.irradiance, 1, value.irradiance_error) << radius;
      EXPECT_NEAR(value.irradiance, 1, 1e-14 / radius) << radius;
    }
  }
}

TEST(ExactTest, ACurveThroughTheReceiverStandsOnItsLeft) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{-2, 0}, {2, 0}});
  AddCurve(scene, SegmentDescription{{0, 0}, {0, 1}});
  AddCurve(scene, ArcDescription{{0, 0}, 9, 0, 2 * kPi}, 1);
  AddProbe(scene, 0, 1);
  EXPECT_NEAR(Solve(*Build(scene), 0)[0].irradiance, 1, 1e-14);
  // A dome that ends there with an upright tangent instead: its near part covers less the nearer one looks, to a limit.
  scene.curves[1].shape = ArcDescription{{-1, 0}, 1, 0, kPi};
  EXPECT_NEAR(Solve(*Build(scene), 0)[0].irradiance, 1, 1e-5);
}

// A wall through the receiver covers its left; where a plate crosses the wall light begins, not at the wall's end
// behind.
TEST(ExactTest, AWallThroughTheReceiverEndsWhereAPlateCrossesIt) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{-1, 0}, {1, 0}});
  AddCurve(scene, SegmentDescription{{-0.2, -0.4}, {0.2, 0.4}});
  AddCurve(scene, SegmentDescription{{1, 0.2}, {-1, 0.2}}, 1);
  AddProbe(scene, 0, 1);
  const WorldValue value = Solve(*Build(scene), 0)[0];
  const auto sine = [](double x) { return x / std::hypot(x, 0.2); };
  const auto slope = [](double x) { return -0.04 / std::pow(std::hypot(x, 0.2), 3); };
  EXPECT_NEAR(value.irradiance, sine(1) - sine(0.1), 1e-14);
  EXPECT_NEAR(value.gradient, slope(1) - slope(0.1), 1e-12);
}

// Two curves through the receiver: beyond it, one hides the other.
TEST(ExactTest, OfTwoCurvesThroughTheReceiverTheOneAheadHides) {
  for (const bool bright_first : {false, true}) {
    SceneDescription scene = EmptyScene();
    AddCurve(scene, SegmentDescription{{-1, 0}, {1, 0}});
    const SegmentDescription ahead{{-0.5, -0.5}, {0.5, 0.5}}, behind{{0.5, -0.5}, {-0.5, 0.5}};
    if (bright_first) AddCurve(scene, ahead, 1, true);
    AddCurve(scene, behind);
    if (!bright_first) AddCurve(scene, ahead, 1, true);
    AddProbe(scene, 0, 1);
    EXPECT_NEAR(Solve(*Build(scene), 0)[0].irradiance, 1 + std::sqrt(0.5), 1e-14) << bright_first;
  }
}

// A wall crosses the lamp exactly where the end of a plate behind both is seen, whatever is found first.
TEST(ExactTest, AHiddenEndBehindACrossingIsNotItsBreakInAnyOrder) {
  const SegmentDescription curves[] = {
      {{1, 1}, {-1, 1}}, {{0.5, 0.7}, {0.5, 1.5}}, {{1, 2}, {2, 1.9}}, {{1.5, 3}, {0, 3}}};
  int order[] = {0, 1, 2, 3};
  do {
    SceneDescription scene = EmptyScene();
    for (const int i : order) AddCurve(scene, curves[i], i == 0 ? 1 : 0, true);
    ExpectOneSided(WithFreePoint(scene, {0, 0}), "hidden end");
  } while (std::next_permutation(std::begin(order), std::end(order)));
}

// The lamp is seen from far away on one side up to the edge of a plate 200 times as near.
TEST(ExactTest, TheSinesOfAFarAndANearEndKeepTheirDigits) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{2, 2}, {-2, 2}}, 1);
  AddCurve(scene, SegmentDescription{{0.8, -0.05}, {0.804028483363, -0.04775931626461274}}, 1.006013217669341, true);
  AddCurve(scene, SegmentDescription{{0.800733975572249, -0.06}, {0.7981164994555591, -0.060624968}});
  AddProbe(scene, 2, 1, Side::kBack);
  Agreement agreement;
  Compare(scene, agreement, "far and near");
  EXPECT_EQ(agreement.compared, 1);
}

// A lamp in line with the floor, to rounding: both its ends lie above the horizon by a few roundoffs.
TEST(ExactTest, ALampInLineWithTheFloorDoesNotFillTheHorizon) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{63948.13813619294, 13028.991924723046}, {65233.04653876298, 14008.692605405686}});
  AddCurve(scene, ArcDescription{{66615.9250094013, 14859.902445831318}, 161.57979535589038, -0.34856743087576847, 2});
  AddCurve(scene,
           SegmentDescription{{62663.232672724924, 12049.287389315201}, {62663.19054559566, 12049.342640376512}});
  AddCurve(scene, SegmentDescription{{65875.50074004801, 14498.542945747004}, {67802.86334390308, 15968.09396677096}},
           1);
  AddProbe(scene, 0, 1, Side::kBack);
  EXPECT_LT(Solve(*Build(scene), 0)[0].irradiance, 1e-14);
}

TEST(ExactTest, NoBoundIsNegativeWhereAnEdgeLiesBelowTheHorizonToRounding) {
  Receiver receiver;
  receiver.normal = {0, 1}, receiver.tangent = {1, 0};
  for (const double curvature : {0.0, -4.0}) {
    const EdgeErrors errors = BoundErrors(VertexEdge(receiver, {1e-4, -1e-8}), curvature, 1e-16);
    EXPECT_GT(errors.s, 0) << curvature;
    EXPECT_GT(errors.s_first, 0) << curvature;
    EXPECT_GT(errors.s_second, 0) << curvature;
  }
}

// Two walls that cross at 1e-7 rad: their distances differ by some 1e-12 of themselves at most.
TEST(ExactTest, WallsThatCrossAtASmallAngleShowOnBothSides) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{2, 1.5}, {-2, 1.5}});
  AddCurve(scene, SegmentDescription{{0.530149624322, -0.0594788564363}, {-0.755382758885, -0.0821842307963}});
  AddCurve(scene, SegmentDescription{{0.437766535947, -0.061110548894}, {-0.645649943414, -0.0802461040811}}, 1, true);
  ProbeDescription probe;
  probe.name = "p", probe.curve = "c0", probe.count = 1, probe.from = 0, probe.to = 1.0 / 3;
  scene.probes.push_back(probe);
  // By the oracle's program in 113 bits; the crossing is known to the roundoff over the angle.
  EXPECT_NEAR(Solve(*Build(scene), 0)[0].irradiance, 5.5467971066666377e-05, 1e-8);
}

// An arc of 2e-9, seen from 2 away, hides the lamp behind it: distances differ by less than areas of that size round.
TEST(ExactTest, TinyCurvesHideEachOther) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{-2, -1.5}, {2, -1.5}});
  AddCurve(scene, ArcDescription{{0.14774188, 0.070307184}, 1.8603962e-09, -0.014918576, -2.8037761});
  AddCurve(scene, SegmentDescription{{0.14774188, 0.070307185}, {0.14774188, 0.070307186}}, 1, true);
  ProbeDescription probe;
  probe.name = "p", probe.curve = "c0", probe.count = 1, probe.from = 0.5, probe.to = 1, probe.side = Side::kFront;
  scene.probes.push_back(probe);
  EXPECT_LT(Solve(*Build(scene), 0)[0].irradiance, 1e-14);
}

// Curves may cross, be receivers, emitters and occluders at once.
TEST(ExactTest, RandomScenesAgreeWithTheOracle) {
  Agreement agreement;
  std::mt19937_64 random(7);
  for (int round = 0; round < 160; ++round) {
    SceneDescription scene = EmptyScene();
    const std::size_t curves = 2 + random() % 6;
    for (std::size_t i = 0; i < curves; ++i) AddRandomCurve(scene, random, round % 4 != 0);
    for (std::size_t i = 0; i < std::min<std::size_t>(curves, 3); ++i) {
      AddProbe(scene, i, 3, Side::kFront);
      AddProbe(scene, i, 2, Side::kBack);
    }
    ProbeDescription free;
    free.name = "free";
    for (int i = 0; i < 3; ++i)
      free.points.push_back({RandomPoint(random), {Uniform(random, -1, 1), Uniform(random, -1, 1)}});
    scene.probes.push_back(free);
    Compare(scene, agreement, "round " + std::to_string(round));
  }
  EXPECT_GT(agreement.compared, 2000);
  EXPECT_LT(agreement.skipped, agreement.compared / 100);
}

// Against differences of the irradiance as the normal turns, at points on the floor and free ones, by all ways of
// finding what is seen.
TEST(ExactTest, RotationIsThatOfTheIrradiance) {
  std::mt19937 random(7);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 8) / 16777216.0;
  };
  constexpr double kStep = 1e-3;
  for (int round = 0; round < 20; ++round) {
    SceneDescription scene = EmptyScene();
    for (int i = 0; i < 6; ++i) {
      const Point2 a{uniform(-1, 1), uniform(0.3, 1.5)};
      AddCurve(scene, SegmentDescription{a, {a.x + uniform(-0.5, 0.5), a.y + uniform(-0.3, 0.3)}}, i % 3);
    }
    if (round % 2 == 0) AddCurve(scene, ArcDescription{{uniform(-1, 1), 2.5}, 0.4, 0, -6.283185307179586}, 1.5);
    if (round % 4 > 1) scene.environment = EnvironmentDescription{{0.7}};
    scene.lights.push_back({"bulb", PointLightDescription{{0.1, 3.2}, {2}}});
    scene.lights.push_back({"spot", SpotLightDescription{{-3, 0.2}, {1, 0}, {3}, 0.1, 1.5}});
    scene.lights.push_back({"sun", DirectionalLightDescription{{-0.3, -1}, {0.2}}});
    ProbeDescription points;
    points.name = "points";
    const Point2 place{uniform(-1, 1), uniform(-0.5, 0.1)};
    for (const double turn : {-2 * kStep, -kStep, 0.0, kStep, 2 * kStep}) {
      const double angle = 0.3 + turn;  // From y toward x, the tangent's side.
      points.points.push_back({place, {std::sin(angle), std::cos(angle)}});
    }
    scene.probes.push_back(points);
    const auto built = Build(scene);
    ASSERT_TRUE(built);
    const RayCaster caster(built);
    ExactSolver solver(*built, caster.bvh(), ExactOptions{});
    const LightSolver lights(caster, ExactOptions{});
    std::vector<ExactValue> values;
    for (const Receiver& receiver : built->probes().back().receivers) {
      values.push_back(solver.Evaluate(receiver));
      lights.Add(receiver, values.back());
    }
    const auto e = [&](std::size_t i) { return values[i].irradiance[0]; };
    const double difference = (8 * (e(3) - e(1)) - (e(4) - e(0))) / (12 * kStep);
    EXPECT_NEAR(values[2].rotation[0], difference, 2e-9 * (1 + e(2))) << round;
    EXPECT_GT(values[2].rotation_error[0], 0);
    EXPECT_LT(values[2].rotation_error[0], 1e-12);
    EXPECT_GT(std::abs(difference), 1e-5);
  }
}

}  // namespace
}  // namespace flatlight
