// SPDX-License-Identifier: Apache-2.0
#include "core/scene/bezier_chain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/scene/element_frame.h"
#include "core/scene/scene.h"

namespace flatlight {
namespace {

const std::vector<Bezier>& Shapes() {
  static const std::vector<Bezier> kAll = {
      {{{-0.9, 0.9}, {-0.5, 1.7}, {0.7, 1.6}, {0.8, 0.8}}},  // An arch.
      {{{-1, -0.1}, {-0.2, 0.45}, {0.1, -0.6}, {1, 0.05}}},  // A wave.
      {{{0, 0}, {1, 0.9}, {-0.2, 1}, {0.7, 0.1}}},           // A loop.
      {{{0, 0}, {1, 1}, {0, 1}, {1, 0}}},                    // A cusp, at one half.
      {{{0, 0}, {1, 1}, {1e-3, 1}, {1, 0}}},                 // Almost one.
      {{{0, 0}, {0, 0}, {0.3, 1}, {1, 0.2}}},                // Stands still at its first point
      {{{0, 0}, {0.3, 1}, {1, 0.2}, {1, 0.2}}},              // and at its last.
      {{{0.5, 0}, {1, 1}, {-1, 1}, {0.5, 0}}},               // Comes back.
      {{{0, 0}, {0.33, 1e-7}, {0.67, -1e-7}, {1, 0}}},       // As good as straight.
  };
  return kAll;
}

TEST(BezierChainTest, FollowsTheCurveWithoutACorner) {
  for (const Bezier& bezier : Shapes()) {
    const double tolerance = 1e-8;
    const BezierChain chain = MakeBezierChain(bezier, tolerance);
    SCOPED_TRACE(&bezier - Shapes().data());
    ASSERT_FALSE(chain.pieces.empty());
    EXPECT_LE(chain.pieces.size(), 600U);
    EXPECT_EQ(chain.pieces.front().element.a, bezier.p[0]);
    EXPECT_EQ(chain.pieces.back().element.b, bezier.p[3]);
    for (std::size_t i = 0; i < chain.pieces.size(); ++i) {
      const Element& element = chain.pieces[i].element;
      const BezierPiece& on = chain.pieces[i].on;
      for (int k = 0; k <= 100 && on.bends; ++k) {
        const double u = on.from + (on.to - on.from) * k / 100;
        EXPECT_LE(DistanceTo(element, bezier.At(u)), on.distance + 1e-16);
        const Vector2 normal = FrontNormal(element, bezier.At(u));
        EXPECT_LE(std::abs(Dot(normal, bezier.Tangent(u, k == 0 ? 1 : -1))), on.tilt + 1e-12);
      }
      EXPECT_LE(on.distance, tolerance);
      if (i == 0) continue;
      const Element& before = chain.pieces[i - 1].element;
      EXPECT_EQ(before.b, element.a);
      if (!on.bends || !chain.pieces[i - 1].on.bends) continue;
      const Vector2 left = FrontNormal(before, before.b), right = FrontNormal(element, element.a);
      const bool cusp = LengthSquared(bezier.First(on.from)) < 1e-20;
      // As coordinates are known; where both are as good as straight, as the arcs would bulge.
      const bool straight = before.kind == Element::Kind::kSegment || element.kind == Element::Kind::kSegment;
      EXPECT_LE(std::abs(Cross(left, right)),
                (straight ? 1e-8 : 1e-12) + 1e-15 / std::min(before.length, element.length));
      EXPECT_EQ(Dot(left, right) < 0, cusp) << i;
    }
  }
}

// Where the curve stands still and turns back no arc follows it: short segments do, as near to it, and as long as it
// is.
TEST(BezierChainTest, TheTipsOfCuspsAreSegmentsOfTheCurvesLength) {
  // Of a cusp to rounding, at places that no power of two names.
  const std::vector<Bezier> cusps = {{{{0, 0}, {1, 1}, {0, 1}, {1, 0}}},
                                     {{{0, 0}, {0.9, 1.1}, {0.9 - 1.0 / 1.35, 1.1}, {0.85, 0.1}}},
                                     {{{0, 0}, {1, 1}, {1e-7, 1}, {1, 0}}}};
  int tips = 0;
  for (const Bezier& bezier : cusps) {
    for (const double tolerance : {1e-8, 1e-5}) {
      for (const BezierChain::Piece& piece : MakeBezierChain(bezier, tolerance).pieces) {
        if (piece.on.bends) continue;
        ++tips;
        const double from = piece.on.from, to = piece.on.to;
        EXPECT_NEAR(piece.element.length, bezier.Length(from, to), 1e-9 * piece.element.length);
        for (int k = 0; k <= 20; ++k)
          EXPECT_LE(DistanceTo(piece.element, bezier.At(from + (to - from) * k / 20)), tolerance);
      }
    }
  }
  EXPECT_GE(tips, 3);
}

TEST(BezierChainTest, HasTheLengthOfTheCurve) {
  for (const Bezier& bezier : Shapes()) {
    double length = 0, sum = 0;
    for (const BezierChain::Piece& piece : MakeBezierChain(bezier, 1e-8).pieces) length += piece.element.length;
    for (int i = 0; i < 100000; ++i) sum += Length(bezier.At((i + 1) / 1e5) - bezier.At(i / 1e5));
    EXPECT_NEAR(length, sum, 2e-9);
  }
}

TEST(BezierChainTest, StraightOnesAreSegments) {
  const BezierChain plain = MakeBezierChain({{{0, 0}, {0.1, 0.1}, {0.8, 0.8}, {1, 1}}}, 1e-9);
  ASSERT_EQ(plain.pieces.size(), 1U);
  EXPECT_EQ(plain.pieces[0].element.kind, Element::Kind::kSegment);
  EXPECT_EQ(plain.pieces[0].element.b, (Point2{1, 1}));
  EXPECT_EQ(MakeBezierChain({{{0, 0}, {0, 0}, {1, 1}, {1, 1}}}, 1e-9).pieces.size(), 1U);
  // There, back, and there again.
  const Bezier turning{{{0, 0}, {2, 0}, {-1, 0}, {1, 0}}};
  const BezierChain back = MakeBezierChain(turning, 1e-9);
  ASSERT_EQ(back.pieces.size(), 3U);
  EXPECT_GT(back.pieces[0].element.b.x, back.pieces[1].element.b.x);
}

TEST(BezierChainTest, AnArcIsOneArcAgain) {
  // No cubic is a circle: to 2.7e-4 of the radius at its best, which the chain must show.
  const double k = 0.5522847498307936;
  const Bezier quarter{{{1, 0}, {1, k}, {k, 1}, {0, 1}}};
  double most = 0;
  for (const BezierChain::Piece& piece : MakeBezierChain(quarter, 1e-8).pieces)
    most = std::max(most, std::abs(Length(piece.element.b - Point2{}) - 1));
  EXPECT_NEAR(most, 2.7253e-4, 1e-6);
}

TEST(BezierChainTest, CurvaturesAreThoseOfTheCurve) {
  const Bezier bezier = Shapes()[1];
  const double h = 1e-4;
  for (double u = 0.05; u < 1; u += 0.09) {
    const double length = bezier.Length(u - h, u + h);
    const Vector2 turn = bezier.Tangent(u + h, 1) - bezier.Tangent(u - h, 1);
    EXPECT_NEAR(Dot(turn, Left(bezier.Tangent(u, 1))) / length, bezier.Curvature(u), 1e-5);
    EXPECT_NEAR((bezier.Curvature(u + h) - bezier.Curvature(u - h)) / length, bezier.CurvatureChange(u), 1e-4);
  }
}

SceneDescription WithProbe(const BezierDescription& bezier, double scale, std::uint32_t count) {
  SceneDescription scene;
  scene.materials.push_back({"black", LambertianDescription{{0}}});
  const auto at = [&](Point2 p) { return Point2{scale * p.x, scale * p.y}; };
  scene.curves.push_back(
      {"c", BezierDescription{at(bezier.p0), at(bezier.p1), at(bezier.p2), at(bezier.p3)}, "black", std::nullopt});
  ProbeDescription probe;
  probe.name = "p", probe.curve = "c", probe.count = count;
  scene.probes.push_back(probe);
  return scene;
}

TEST(BezierChainTest, ProbePointsLieAtEqualArcLengthsOfTheCurveItself) {
  for (const double scale : {1e-9, 1.0, 1e9}) {
    const BezierDescription wave{{-1, -0.1}, {-0.2, 0.45}, {0.1, -0.6}, {1, 0.05}};
    Diagnostics diagnostics;
    const auto scene = BuildScene(WithProbe(wave, scale, 8), diagnostics);
    ASSERT_TRUE(scene);
    const Bezier bezier{{wave.p0, wave.p1, wave.p2, wave.p3}};
    double whole = 0;
    const int panels = 256;
    for (int i = 0; i < panels; ++i) whole += bezier.Length(i / 256.0, (i + 1) / 256.0);
    for (int k = 0; k < 8; ++k) {
      const Receiver& receiver = scene->probes()[0].receivers[static_cast<std::size_t>(k)];
      const double target = (k + 0.5) / 8 * whole;
      double length = 0, u = 0;
      for (int i = 0; i < panels; ++i) {
        const double piece = bezier.Length(i / 256.0, (i + 1) / 256.0);
        if (length + piece >= target) {
          u = bezier.AtLength(target - length, i / 256.0, (i + 1) / 256.0);
          break;
        }
        length += piece;
      }
      const Point2 at = scene->ToWorld(receiver.position + receiver.offset);
      EXPECT_NEAR(at.x / scale, bezier.At(u).x, 1e-14);
      EXPECT_NEAR(at.y / scale, bezier.At(u).y, 1e-14);
      EXPECT_NEAR(Cross(receiver.tangent, bezier.Tangent(u, 1)), 0, 1e-14);
      const double unit = scene->frame().scale / scale;
      EXPECT_NEAR(receiver.curvature / unit, bezier.Curvature(u), 1e-12);
      EXPECT_NEAR(receiver.curvature_change / unit / unit, bezier.CurvatureChange(u), 1e-11);
      EXPECT_NE(receiver.element, ElementId::kNone);
    }
  }
}

TEST(BezierChainTest, APointIsRefused) {
  Diagnostics diagnostics;
  EXPECT_FALSE(BuildScene(WithProbe({{1, 2}, {1, 2}, {1, 2}, {1, 2}}, 1, 4), diagnostics));
  ASSERT_EQ(diagnostics.count(), 1U);
  EXPECT_EQ(diagnostics.kept()[0].path, "plane.curves[0].bezier");
  EXPECT_EQ(diagnostics.kept()[0].message,
            "has zero length: p0, p1, p2 and p3 are all (1, 2); one of them must differ");
}

TEST(BezierChainTest, AFreePointOnTheCurveLiesOnIt) {
  SceneDescription scene = WithProbe({{-0.9, 0.9}, {-0.5, 1.7}, {0.7, 1.6}, {0.8, 0.8}}, 1, 4);
  const Bezier bezier{{{-0.9, 0.9}, {-0.5, 1.7}, {0.7, 1.6}, {0.8, 0.8}}};
  ProbeDescription free;
  free.name = "free";
  const double u = 0.377;
  free.points.push_back({bezier.At(u), Left(bezier.Tangent(u, 1))});
  free.points.push_back({bezier.At(u), Right(bezier.Tangent(u, 1))});
  free.points.push_back({bezier.At(u), {1, 0.3}});
  scene.probes.push_back(free);
  Diagnostics diagnostics;
  const auto built = BuildScene(scene, diagnostics);
  ASSERT_TRUE(built);
  const auto& receivers = built->probes()[1].receivers;
  EXPECT_NE(receivers[0].element, ElementId::kNone);
  EXPECT_EQ(receivers[1].element, receivers[0].element);
  EXPECT_EQ(receivers[2].element, ElementId::kNone);  // Turned: lifted off the curve and the arcs.
  EXPECT_GT(DistanceTo(built->element(receivers[0].element), receivers[2].position),
            2 * built->bezier_piece(built->element(receivers[0].element))->distance);
}

}  // namespace
}  // namespace flatlight
