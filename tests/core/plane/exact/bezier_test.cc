// SPDX-License-Identifier: Apache-2.0
// Exact light of Bézier curves: as receivers, emitters and blockers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/plane/exact/exact.h"
#include "core/scene/scene.h"
#include "tests/core/plane/exact/bezier_oracle.h"
#include "tests/core/plane/exact/test_scenes.h"

namespace flatlight {
namespace {

constexpr BezierDescription kArch{{-0.9, 0.9}, {-0.5, 1.7}, {0.7, 1.6}, {0.8, 0.8}};
constexpr BezierDescription kBulge{{0.4, 0.5}, {0.1, 0.75}, {-0.15, 0.65}, {-0.3, 0.45}};
constexpr BezierDescription kValley{{-1, 0.1}, {-0.4, -0.3}, {0.3, -0.25}, {1, 0.15}};
constexpr BezierDescription kWave{{-1, -0.1}, {-0.2, 0.45}, {0.1, -0.6}, {1, 0.05}};
// Turns by more than a quarter, and less than half, so that it hides much from itself.
constexpr BezierDescription kHook{{-0.3, 0.2}, {0.5, 0.9}, {0.55, 1.05}, {0.4, 0.6}};
constexpr SegmentDescription kFloor{{-1, -0.2}, {1, -0.3}};
constexpr SegmentDescription kLamp{{0.6, 1.2}, {-0.7, 1.25}};

BezierDescription Reversed(const BezierDescription& b) { return {b.p3, b.p2, b.p1, b.p0}; }

// Every point of every probe.
void Compare(const SceneDescription& description, const std::string& what) {
  const auto scene = Build(description);
  ASSERT_TRUE(scene);
  const BezierOracle oracle(description);
  int skipped = 0, points = 0;
  for (std::size_t p = 0; p < description.probes.size(); ++p) {
    const ProbeDescription& probe = description.probes[p];
    const std::size_t curve = std::stoul(probe.curve->substr(1));
    const std::vector<WorldValue> values = Solve(*scene, p);
    points += static_cast<int>(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Receiver& receiver = scene->probes()[p].receivers[i];
      const Point2 at = scene->ToWorld(receiver.position + receiver.offset);
      const auto u = oracle.Find(curve, at.x, at.y);
      const auto truth = oracle.OnCurve(curve, u, *probe.side == Side::kBack ? -1 : 1);
      if (!truth) {
        ++skipped;
        continue;
      }
      const WorldValue& v = values[i];
      const std::string where = what + ", probe " + std::to_string(p) + ", point " + std::to_string(i);
      EXPECT_LE(v.irradiance_error, 2e-11) << where;
      EXPECT_NEAR(v.irradiance, truth->irradiance, std::min(1e-13, v.irradiance_error + 1e-16)) << where;
      EXPECT_NEAR(v.gradient, truth->gradient, v.gradient_error + 1e-10 * (1 + std::abs(truth->gradient))) << where;
      EXPECT_NEAR(v.hessian, truth->hessian, v.hessian_error + 3e-9 * (1 + std::abs(truth->hessian))) << where;
    }
  }
  EXPECT_LT(10 * skipped, points) << what;
}

TEST(BezierTest, Emitter) {
  for (const BezierDescription& arch : {kArch, Reversed(kArch), kWave}) {
    SceneDescription scene = EmptyScene();
    AddCurve(scene, SegmentDescription{{-1, -0.6}, {1, -0.7}});
    AddCurve(scene, arch, 2);
    AddProbe(scene, 0, 23);
    Compare(scene, "emitter");
  }
}

TEST(BezierTest, Blocker) {
  for (const BezierDescription& blocker : {kBulge, Reversed(kBulge)}) {
    SceneDescription scene = EmptyScene();
    AddCurve(scene, kFloor);
    AddCurve(scene, kLamp, 3);
    AddCurve(scene, blocker);
    AddProbe(scene, 0, 29);
    Compare(scene, "blocker");
  }
}

TEST(BezierTest, Receiver) {
  for (const BezierDescription& receiver : {kValley, kWave, kBulge, Reversed(kValley), kHook}) {
    SceneDescription scene = EmptyScene();
    AddCurve(scene, receiver);
    AddCurve(scene, kLamp, 3);
    AddProbe(scene, 0, 31);
    AddProbe(scene, 0, 31, Side::kBack);
    Compare(scene, "receiver");
  }
}

TEST(BezierTest, ReceiverEmitterAndBlockerAtOnce) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, kValley, 0.7);
  AddCurve(scene, Reversed(kArch), 3);
  AddCurve(scene, kBulge, 1.3);
  AddProbe(scene, 0, 37);
  AddProbe(scene, 1, 19);
  AddProbe(scene, 1, 19, Side::kBack);
  AddProbe(scene, 2, 17);
  AddProbe(scene, 2, 17, Side::kBack);
  Compare(scene, "all");
}

SceneDescription Everything(const BezierDescription& receiver, double scale) {
  const auto at = [&](Point2 p) { return Point2{scale * p.x, scale * p.y}; };
  const auto scaled = [&](const BezierDescription& b) {
    return BezierDescription{at(b.p0), at(b.p1), at(b.p2), at(b.p3)};
  };
  SceneDescription scene = EmptyScene();
  AddCurve(scene, scaled(receiver));
  AddCurve(scene, scaled(Reversed(kArch)), 3);
  AddCurve(scene, scaled(kBulge), 1.3);
  return scene;
}

TEST(BezierTest, ReversedItsFrontIsItsBack) {
  SceneDescription scene = Everything(kWave, 1), reversed = Everything(Reversed(kWave), 1);
  AddProbe(scene, 0, 40);
  AddProbe(reversed, 0, 40, Side::kBack);
  const std::vector<WorldValue> values = Solve(*Build(scene), 0), others = Solve(*Build(reversed), 0);
  for (std::size_t i = 0; i < 40; ++i) {
    const WorldValue &v = values[i], &w = others[39 - i];
    EXPECT_NEAR(v.irradiance, w.irradiance, v.irradiance_error + w.irradiance_error);
    EXPECT_NEAR(v.gradient, -w.gradient, v.gradient_error + w.gradient_error);
    EXPECT_NEAR(v.hessian, w.hessian, v.hessian_error + w.hessian_error);
  }
}

TEST(BezierTest, AnySizeIsLitAlike) {
  SceneDescription one = Everything(kWave, 1);
  AddProbe(one, 0, 40);
  const std::vector<WorldValue> values = Solve(*Build(one), 0);
  for (const double scale : {1e-9, 3e4, 1e9}) {
    SceneDescription scene = Everything(kWave, scale);
    AddProbe(scene, 0, 40);
    const std::vector<WorldValue> others = Solve(*Build(scene), 0);
    for (std::size_t i = 0; i < 40; ++i) {
      const WorldValue &v = values[i], &w = others[i];
      EXPECT_NEAR(v.irradiance, w.irradiance, v.irradiance_error + w.irradiance_error);
      EXPECT_NEAR(v.gradient, scale * w.gradient, v.gradient_error + scale * w.gradient_error);
      EXPECT_NEAR(v.hessian, scale * scale * w.hessian, v.hessian_error + scale * scale * w.hessian_error);
    }
  }
}

// By de Casteljau's rule.
std::pair<BezierDescription, BezierDescription> Split(const BezierDescription& b, double u) {
  const auto mix = [&](Point2 p, Point2 q) { return p + u * (q - p); };
  const Point2 a = mix(b.p0, b.p1), m = mix(b.p1, b.p2), c = mix(b.p2, b.p3), am = mix(a, m), mc = mix(m, c);
  const Point2 middle = mix(am, mc);
  return {{b.p0, a, am, middle}, {middle, mc, c, b.p3}};
}

TEST(BezierTest, CutInTwoItIsTheSameCurve) {
  for (const double u : {0.5, 0.31}) {
    SceneDescription whole = EmptyScene(), cut = EmptyScene();
    for (SceneDescription* scene : {&whole, &cut}) {
      AddCurve(*scene, SegmentDescription{{-1, -0.6}, {1, -0.7}});
      AddProbe(*scene, 0, 50);
    }
    AddCurve(whole, kArch, 2), AddCurve(whole, kBulge, 0.5), AddCurve(whole, kWave);
    for (const auto& [curve, radiance] : {std::pair{kArch, 2.0}, {kBulge, 0.5}, {kWave, 0.0}}) {
      const auto [first, second] = Split(curve, u);
      AddCurve(cut, first, radiance), AddCurve(cut, second, radiance);
    }
    const std::vector<WorldValue> values = Solve(*Build(whole), 0), others = Solve(*Build(cut), 0);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const WorldValue &v = values[i], &w = others[i];
      EXPECT_NEAR(v.irradiance, w.irradiance, v.irradiance_error + w.irradiance_error) << i;
      EXPECT_NEAR(v.gradient, w.gradient, v.gradient_error + w.gradient_error) << i;
      EXPECT_NEAR(v.hessian, w.hessian, 2 * (v.hessian_error + w.hessian_error)) << i;
    }
  }
}

TEST(BezierTest, AStraightOneIsTheSegment) {
  SceneDescription bezier = EmptyScene(), segment = EmptyScene();
  for (SceneDescription* scene : {&bezier, &segment}) AddCurve(*scene, kFloor);
  const Point2 a = kLamp.a, b = kLamp.b;
  AddCurve(bezier, BezierDescription{a, a + 0.2 * (b - a), a + 0.9 * (b - a), b}, 3);
  AddCurve(segment, kLamp, 3);
  for (SceneDescription* scene : {&bezier, &segment}) AddProbe(*scene, 0, 16), AddProbe(*scene, 1, 16);
  for (const std::size_t probe : {0u, 1u}) {
    const std::vector<WorldValue> values = Solve(*Build(bezier), probe), others = Solve(*Build(segment), probe);
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(values[i].hessian, others[i].hessian);
  }
}

// On the tangent at the joint of two arcs, and beside it: the break is the curve's touching point, no end of an arc.
TEST(BezierTest, JointsAreNoVertices) {
  const BezierDescription cap{{-0.5, 0.5}, {-0.3, 0.9}, {0.3, 0.9}, {0.5, 0.5}};
  SceneDescription scene = EmptyScene();
  AddCurve(scene, cap);
  AddCurve(scene, SegmentDescription{{3, 2}, {-3, 2}}, 1);
  const auto probe_scene = Build(scene = WithFreePoint(scene, {0, 0}));
  ASSERT_TRUE(probe_scene);
  for (const Element& element : probe_scene->elements()) {
    const BezierPiece* on = probe_scene->bezier_piece(element);
    if (on == nullptr || on->from == 0) continue;
    // Away from the joint along its tangent, looking up.
    const Bezier& bezier = probe_scene->beziers()[on->bezier];
    const Vector2 tangent = bezier.Tangent(on->from, 1);
    const Point2 touch = element.a;
    Receiver receiver;
    receiver.position = touch + -1.3 * tangent;
    receiver.normal = {0.6, 0.8}, receiver.tangent = Right(receiver.normal);
    const Bvh bvh(*probe_scene);
    ExactSolver solver(*probe_scene, bvh, {});
    const double at = solver.Evaluate(receiver).hessian[0];
    receiver.position = receiver.position + 1e-7 * Left(tangent);
    const double beside = solver.Evaluate(receiver).hessian[0];
    EXPECT_NEAR(at, beside, 1e-5) << on->from;
  }
}

// Beside an end where control points coincide the curvature grows without limit, and so does what roundings of these
// and of the place make of it.
TEST(BezierTest, BoundsGrowTowardAnEndWhereTheCurveStandsStill) {
  const auto value_at = [](const BezierDescription& curve, double from, double to, Side side) {
    SceneDescription scene = EmptyScene();
    AddCurve(scene, curve);
    AddCurve(scene, kLamp, 3);
    AddProbe(scene, 0, 1, side);
    scene.probes.back().from = from, scene.probes.back().to = to;
    return Solve(*Build(scene), 0)[0];
  };
  for (const double share : {1e-2, 1e-4, 1e-6}) {
    BezierDescription curve{{-1, 0.1}, {-0.4, -0.3}, {0.9, 0.1}, {0.9, 0.1}};
    const WorldValue value = value_at(curve, 1 - share, 1, Side::kFront);
    const WorldValue reversed = value_at(Reversed(curve), 0, share, Side::kBack);
    curve.p1.x = std::nextafter(curve.p1.x, 0), curve.p1.y = std::nextafter(curve.p1.y, 0);
    const WorldValue nudged = value_at(curve, 1 - share, 1, Side::kFront);
    EXPECT_NEAR(value.irradiance, reversed.irradiance, value.irradiance_error + reversed.irradiance_error) << share;
    EXPECT_NEAR(value.gradient, -reversed.gradient, value.gradient_error + reversed.gradient_error) << share;
    EXPECT_NEAR(value.hessian, reversed.hessian, value.hessian_error + reversed.hessian_error) << share;
    EXPECT_NEAR(value.gradient, nudged.gradient, value.gradient_error + nudged.gradient_error) << share;
    EXPECT_NEAR(value.hessian, nudged.hessian, value.hessian_error + nudged.hessian_error) << share;
    EXPECT_LT(value.hessian_error, 1e-3 * std::abs(value.hessian)) << share;
  }
}

// A lamp that crosses another Bézier at a small angle: where, is known to the distance of arcs and curves over its
// sine.
TEST(BezierTest, TheBoundHoldsWhereArcsCrossElsewhereThanTheirCurves) {
  const BezierDescription wall{{-0.7347509530960974, -0.11704079349858376},
                               {-1.5085333617701093, 0.2963144569058832},
                               {-0.6444635235201217, -0.2391335828500733},
                               {-0.06923025439618868, -0.12973268002734867}};
  const BezierDescription lamp{{-0.3078474920271573, 0.05128318155360195},
                               {0.16436391198678513, -0.09506920099445837},
                               {0.3436061493556316, -0.28094761686064834},
                               {-0.5754557836913134, -0.09542169012991869}};
  SceneDescription scene = EmptyScene(), reversed = EmptyScene();
  AddCurve(scene, wall), AddCurve(scene, lamp, 1, true);
  AddCurve(reversed, Reversed(wall)), AddCurve(reversed, Reversed(lamp), 1, true);
  for (SceneDescription* one : {&scene, &reversed}) {
    ProbeDescription probe;
    probe.name = "free";
    probe.points.push_back({{-0.4, -0.5}, {1, 0.04}});
    one->probes.push_back(probe);
  }
  const WorldValue value = Solve(*Build(scene), 0)[0], other = Solve(*Build(reversed), 0)[0];
  EXPECT_NEAR(value.irradiance, other.irradiance, value.irradiance_error + other.irradiance_error);
  EXPECT_GT(std::abs(value.irradiance - other.irradiance), 1e-7);  // Their arcs differ.
  EXPECT_LT(value.irradiance_error, 1e-6);
}

// One turns back within less than arcs follow it: what follows it there has a corner, the curve has none. Its touching
// point is found on the curve, whichever way that runs.
TEST(BezierTest, ATipThatIsSharperThanArcsFollowTouchesAsTheCurveDoes) {
  const BezierDescription tip{{-0.23891922209295258, -0.3378515455727591},
                              {0.2580391464700607, -0.2638353870218076},
                              {-0.31293318116849766, -0.3029660690116188},
                              {-0.3122503793280489, -0.5136621294593928}};
  SceneDescription scene = EmptyScene(), reversed = EmptyScene();
  AddCurve(scene, tip), AddCurve(reversed, Reversed(tip));
  for (SceneDescription* one : {&scene, &reversed}) {
    AddCurve(*one, SegmentDescription{{-0.6, -0.6}, {0.6, -0.6}}, 1);
    ProbeDescription probe;
    probe.name = "free";
    probe.points.push_back({{0.3916523266892864, 0.20180668073544972}, {0.08330096601361044, -0.996524434753709}});
    one->probes.push_back(probe);
  }
  const WorldValue value = Solve(*Build(scene), 0)[0], other = Solve(*Build(reversed), 0)[0];
  EXPECT_NEAR(value.irradiance, other.irradiance, value.irradiance_error + other.irradiance_error);
  EXPECT_NEAR(value.gradient, other.gradient, value.gradient_error + other.gradient_error);
  EXPECT_NEAR(value.hessian, other.hessian, value.hessian_error + other.hessian_error);
  EXPECT_LT(value.irradiance_error, 1e-12);
}

// Light around a circle of radius 30, a Bézier before it, and a free point.
WorldValue ValueBehind(const BezierDescription& curve, Point2 place, Vector2 normal) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, curve);
  AddCurve(scene, ArcDescription{{0, 0}, 30, 0, 2 * kPi}, 1);
  ProbeDescription probe;
  probe.name = "free";
  probe.points.push_back({place, normal});
  scene.probes.push_back(probe);
  return Solve(*Build(scene), 0)[0];
}

void ExpectAlike(const WorldValue& value, const WorldValue& other) {
  EXPECT_NEAR(value.irradiance, other.irradiance, value.irradiance_error + other.irradiance_error);
  EXPECT_NEAR(value.gradient, other.gradient, value.gradient_error + other.gradient_error);
  EXPECT_NEAR(value.hessian, other.hessian, value.hessian_error + other.hessian_error);
}

// A touching point of the arcs may fall on a joint of theirs. The curve has its own, beside it: here 1e-13 away, on a
// tip of radius 3e-7. The truth is 2 less what the curve hides, to 60 digits.
TEST(BezierTest, ASilhouetteAtAJointOfArcsIsWhereTheCurveHasIt) {
  const BezierDescription tip{{-0.2678552143172297, -0.026800681806111504},
                              {-0.18902410462386832, 0.63504627464474206},
                              {0.18160389037534427, 2.0667548332115726},
                              {-0.46627046021460683, -0.6675138497450539}};
  const Point2 place{-0.13282066628222597, 0.75976358559922175};
  const Vector2 normal{0.85186735480971976, 0.52375758687535112};
  const WorldValue value = ValueBehind(tip, place, normal), reversed = ValueBehind(Reversed(tip), place, normal);
  ExpectAlike(value, reversed);
  for (const WorldValue& v : {value, reversed}) {
    EXPECT_NEAR(v.irradiance, 0.28635621884872034, v.irradiance_error);
    EXPECT_LT(v.irradiance_error, 1e-11);
  }
}

// The same from anywhere on the tangents near the sharpest places of random curves.
TEST(BezierTest, FromTheTangentsOfSharpPlacesCurvesLookAlikeReversed) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 150; ++i) {
    std::array<Point2, 4> p;
    for (Point2& point : p) point = {uniform(random), uniform(random)};
    const BezierDescription curve{p[0], p[1], p[2], p[3]};
    const Bezier bezier({p[0], p[1], p[2], p[3]});
    double sharpest = 0;
    for (int k = 0; k <= 200; ++k)
      if (std::abs(bezier.Curvature(k / 200.0)) > std::abs(bezier.Curvature(sharpest))) sharpest = k / 200.0;
    const double u = std::clamp(sharpest + 1e-3 * uniform(random), 0.0, 1.0);
    const Vector2 first = bezier.First(u);
    const double distance = std::pow(10, -1.5 + 1.5 * uniform(random));
    const Point2 place = bezier.At(u) + (distance / Length(first)) * first;
    const double angle = kPi * uniform(random);
    SCOPED_TRACE(i);
    ExpectAlike(ValueBehind(curve, place, {std::cos(angle), std::sin(angle)}),
                ValueBehind(Reversed(curve), place, {std::cos(angle), std::sin(angle)}));
  }
}

// Near an inflection the radius of curvature is large and changes fast: how far the touching point slides as
// coordinates round makes more of it, and of the second derivative, than all else.
TEST(BezierTest, NearAnInflectionTheBoundHoldsWhatTheTouchingPointMakesOfItsRadius) {
  const BezierDescription wave{{0.20097049277667889, -0.31851036166143065},
                               {-0.89122761995529043, 0.67205042880347432},
                               {0.58472130602344552, -0.14846045474656022},
                               {0.71784766350074869, -0.22246738524730558}};
  // Every number moved by one of two roundings of the scene's size, or by none.
  const auto value_at = [&](std::mt19937_64* random) {
    BezierDescription curve = wave;
    Point2 place{1.6580086706737012, -0.74509243645020318};
    for (Point2* point : {&curve.p0, &curve.p1, &curve.p2, &curve.p3, &place}) {
      if (random == nullptr) break;
      point->x += (*random)() % 2 == 0 ? 0x1p-52 : -0x1p-52;
      point->y += (*random)() % 2 == 0 ? 0x1p-52 : -0x1p-52;
    }
    SceneDescription scene = EmptyScene();
    AddCurve(scene, curve);
    AddCurve(scene, ArcDescription{{0, 0}, 4, 0, 2 * kPi}, 1);
    ProbeDescription probe;
    probe.name = "free";
    probe.points.push_back({place, {-0.94848607847479938, 0.31681881089906383}});
    scene.probes.push_back(probe);
    return Solve(*Build(scene), 0)[0];
  };
  const WorldValue value = value_at(nullptr);
  std::mt19937_64 random(3);
  double widest = 0;
  for (int i = 0; i < 32; ++i) {
    const WorldValue other = value_at(&random);
    EXPECT_NEAR(value.irradiance, other.irradiance, value.irradiance_error + other.irradiance_error);
    EXPECT_NEAR(value.gradient, other.gradient, value.gradient_error + other.gradient_error);
    EXPECT_NEAR(value.hessian, other.hessian, value.hessian_error + other.hessian_error);
    widest = std::max(widest, std::abs(value.hessian - other.hessian));
  }
  EXPECT_GT(widest, 3e-10);
  EXPECT_LT(value.hessian_error, 1e-6);
}

}  // namespace
}  // namespace flatlight
