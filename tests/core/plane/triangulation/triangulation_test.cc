// SPDX-License-Identifier: Apache-2.0
#include "core/plane/triangulation/triangulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>

#include "core/math/vec.h"
#include "core/plane/triangulation/predicates.h"
#include "core/scene/description.h"
#include "core/scene/scene.h"
#include "tests/core/plane/random_curves.h"

namespace flatlight {
namespace {

// Segments that cross, end on one another to rounding, and share ends.
SceneDescription Tangle(Random& random, int count) {
  SceneDescription scene;
  for (int i = 0; i < count; ++i) {
    const Point2 a = random.Point(), b = a + 0.4 * random.Uniform(0.1, 1) * random.Direction();
    AddCurve(scene, SegmentDescription{a, b});
    const Point2 on = a + random.Uniform(0.1, 0.9) * (b - a);
    if (i % 3 == 0) AddCurve(scene, SegmentDescription{on, on + 0.3 * random.Direction()});
    if (i % 4 == 0) AddCurve(scene, PolylineDescription{{b, random.Point(), a}, false});
  }
  return scene;
}

Point2 Place(const Element& element, double share) { return element.a + share * (element.b - element.a); }

TEST(TriangulationTest, EveryPlaceOfAnElementHasAnEdgeThatLeadsToBothSides) {
  Random random(4);
  for (int round = 0; round < 20; ++round) {
    const auto scene = BuildWithProbe(Tangle(random, 20));
    ASSERT_TRUE(scene);
    const auto made = Triangulation::Of(*scene);
    ASSERT_TRUE(made);
    for (std::uint32_t e = 0; e < scene->elements().size(); ++e) {
      const Element& element = scene->elements()[e];
      for (int i = 0; i < 50; ++i) {
        const Point2 place = Place(element, random.Uniform(0, 1));
        for (const bool front : {false, true}) {
          const Gate gate = made->GateAt(*scene, static_cast<ElementId>(e), place, front);
          ASSERT_LT(gate, Triangulation::kWall);
          const Triangulation::Triangle& triangle = made->triangles()[gate / Triangulation::kTriangle];
          const std::uint32_t apex = gate % Triangulation::kTriangle;
          // From the other side this edge is the element's, with this side seen.
          const Gate wall = triangle.gate[apex];
          ASSERT_GE(wall, Triangulation::kWall);
          EXPECT_EQ(Triangulation::ElementOf(wall), e);
          EXPECT_EQ(Triangulation::ShowsFront(wall), front);
          const Point2 from = made->vertices()[triangle.vertex[(apex + 1) % 3]];
          const Point2 to = made->vertices()[triangle.vertex[(apex + 2) % 3]];
          const double length = Length(to - from);
          EXPECT_LE(std::abs(Cross(to - from, place - from)), 4 * scene->touch_distance() * length);
          EXPECT_GE(Dot(to - from, place - from), -1e-12 * length);
          EXPECT_LE(Dot(to - from, place - from), length * (length + 1e-12));
          EXPECT_EQ(Dot(to - from, element.b - element.a) > 0, front);
        }
      }
    }
  }
}

TEST(TriangulationTest, NoGatesLeadThroughElements) {
  Random random(5);
  for (int round = 0; round < 10; ++round) {
    const auto scene = BuildWithProbe(Tangle(random, 20));
    const auto made = Triangulation::Of(*scene);
    ASSERT_TRUE(made);
    for (std::uint32_t t = 0; t < made->triangles().size(); ++t) {
      const Triangulation::Triangle& triangle = made->triangles()[t];
      EXPECT_EQ(triangle.gate[3], triangle.gate[0]);
      EXPECT_EQ(triangle.gate[4], triangle.gate[1]);
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Gate gate = triangle.gate[k];
        if (gate >= Triangulation::kWall) continue;
        // Back again.
        const Triangulation::Triangle& next = made->triangles()[gate / Triangulation::kTriangle];
        EXPECT_EQ(next.gate[gate % Triangulation::kTriangle], Triangulation::kTriangle * t + k);
        const Point2 a = made->vertices()[triangle.vertex[(k + 1) % 3]],
                     b = made->vertices()[triangle.vertex[(k + 2) % 3]];
        for (const Element& element : scene->elements()) {
          const auto apart = [&](Point2 p, Point2 q, Point2 r, Point2 s) {
            const double bound = 16 * scene->touch_distance() * Length(q - p);
            return std::min(Cross(q - p, r - p), Cross(q - p, s - p)) > -bound ||
                   std::max(Cross(q - p, r - p), Cross(q - p, s - p)) < bound;
          };
          EXPECT_TRUE(apart(a, b, element.a, element.b) || apart(element.a, element.b, a, b));
        }
      }
    }
  }
}

TEST(TriangulationTest, PointsAreFoundInTheTrianglesThatTheyLieIn) {
  Random random(6);
  const auto scene = BuildWithProbe(Tangle(random, 60));
  const auto made = Triangulation::Of(*scene);
  ASSERT_TRUE(made);
  for (int i = 0; i < 5000; ++i) {
    const Point2 p = i % 2 == 0 ? random.Point() : Point2{} + 1.9 * (random.Point() - Point2{});
    const std::uint32_t found = made->Locate(*scene, p);
    ASSERT_NE(found, Triangulation::kNone);
    const std::uint32_t* vertex = made->triangles()[found].vertex;
    for (int k = 0; k < 3; ++k)
      EXPECT_GE(Orientation(made->vertices()[vertex[k]], made->vertices()[vertex[(k + 1) % 3]], p), 0);
  }
  EXPECT_EQ(made->Locate(*scene, {2.5, 0}), Triangulation::kNone);
}

TEST(TriangulationTest, CrossingsAndEndsOnOthersBecomeVertices) {
  SceneDescription description;
  AddCurve(description, SegmentDescription{{-1, 0}, {1, 0}});
  AddCurve(description, SegmentDescription{{-0.5, -0.5}, {-0.5, 0.5}});     // Crosses.
  AddCurve(description, SegmentDescription{{0.25, 0x1p-52}, {0.25, 0.5}});  // Stops short by rounding.
  AddCurve(description, SegmentDescription{{0.25, 0.5}, {-0.5, 0.5}});      // Shares two ends.
  const auto scene = BuildWithProbe(description);
  const auto made = Triangulation::Of(*scene);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->vertices().size(), 4u + 2 + 2 + 2 + 1) << "corners, ends, and the crossing";
  EXPECT_EQ(made->triangles().size(), 2 * made->vertices().size() - 6);
  std::size_t walls = 0;
  for (const Triangulation::Triangle& triangle : made->triangles())
    for (int k = 0; k < 3; ++k)
      walls += triangle.gate[k] >= Triangulation::kWall && triangle.gate[k] < Triangulation::kShared ? 1 : 0;
  EXPECT_EQ(walls, 2u * (3 + 2 + 1 + 1)) << "the first is cut in three, the second in two";
  double uncertain = 0;
  for (std::uint32_t v = 0; v < made->vertices().size(); ++v) uncertain = std::max(uncertain, made->Uncertain(v));
  EXPECT_EQ(uncertain, 3 * scene->coordinate_error()) << "of the crossing, at a right angle";
}

TEST(TriangulationTest, WallsSayWhetherTheirSidesShine) {
  SceneDescription description;
  AddCurve(description, SegmentDescription{{0, 0}, {1, 0}});
  description.curves[0].emission = EmissionDescription{{1}};
  const auto scene = BuildWithProbe(description);
  const auto made = Triangulation::Of(*scene);
  int dark = 0, bright = 0;
  for (const Triangulation::Triangle& triangle : made->triangles()) {
    for (int k = 0; k < 3; ++k) {
      const Gate gate = triangle.gate[k];
      if (gate < Triangulation::kWall || gate == Triangulation::kNothing) continue;
      EXPECT_EQ(Triangulation::IsDark(gate), !Triangulation::ShowsFront(gate));
      (Triangulation::IsDark(gate) ? dark : bright) += 1;
    }
  }
  EXPECT_EQ(dark, 1);
  EXPECT_EQ(bright, 1);
}

TEST(TriangulationTest, ThereIsNoneWhereItWouldNotDo) {
  SceneDescription arcs;
  AddCurve(arcs, SegmentDescription{{-1, 0}, {1, 0}});
  AddCurve(arcs, ArcDescription{{0, 0.5}, 0.2, 0, 3});
  EXPECT_FALSE(Triangulation::Of(*BuildWithProbe(arcs)));
  SceneDescription tiny;
  AddCurve(tiny, SegmentDescription{{-1, 0}, {1, 0}});
  AddCurve(tiny, SegmentDescription{{0, 1e-3}, {0, 1e-3 + 1e-15}});
  EXPECT_FALSE(Triangulation::Of(*BuildWithProbe(tiny)));
  SceneDescription lattice;
  for (int i = 0; i < 40; ++i) {
    const double x = i / 40.0;
    AddCurve(lattice, SegmentDescription{{x, -1}, {x, 1}});
    AddCurve(lattice, SegmentDescription{{-1, x}, {1, x}});
  }
  EXPECT_FALSE(Triangulation::Of(*BuildWithProbe(lattice))) << "1600 crossings of 80 elements";
}

// Points on a smooth curve lie on many circles through one another.
TEST(TriangulationTest, SmoothCurvesOfManyPiecesAreTriangulated) {
  constexpr int kPieces = 4000;
  const auto polyline = [&](auto place) {
    PolylineDescription line;
    for (int i = 0; i <= kPieces; ++i) line.points.push_back(place(static_cast<double>(i) / kPieces));
    return line;
  };
  SceneDescription circle, parabola, spiral;
  AddCurve(circle, polyline([](double t) { return Point2{std::cos(6 * t), std::sin(6 * t)}; }));
  AddCurve(parabola, polyline([](double t) { return Point2{2 * t - 1, (2 * t - 1) * (2 * t - 1)}; }));
  AddCurve(spiral, polyline([](double t) { return Point2{t * std::cos(90 * t), t * std::sin(90 * t)}; }));
  for (const SceneDescription& description : {circle, parabola, spiral}) {
    const auto scene = BuildWithProbe(description);
    const auto made = Triangulation::Of(*scene);
    ASSERT_TRUE(made);
    EXPECT_EQ(made->vertices().size(), 4u + kPieces + 1);
  }
}

// Ends beside a wall, each within the touch distance of the line from the one before to the wall's end, lead away from
// the wall by far more than that: they are left to the tree.
TEST(TriangulationTest, WallsDoNotFollowEndsThatLeaveThem) {
  SceneDescription description;
  AddCurve(description, SegmentDescription{{-1, 0}, {1, 0}});
  for (int i = 1; i < 400; ++i) {
    const double share = i / 400.0;
    const Point2 end{-1 + 2 * share, 0x1p-50 * 400 * share * (1 - share)};
    AddCurve(description, SegmentDescription{end, {end.x, 0.5}});
  }
  EXPECT_FALSE(Triangulation::Of(*BuildWithProbe(description)));
}

TEST(TriangulationTest, MemoryIsBounded) {
  Random random(7);
  for (const int count : {10, 100, 1000}) {
    const auto scene = BuildWithProbe(Tangle(random, count));
    const auto made = Triangulation::Of(*scene);
    EXPECT_TRUE(!made || made->bytes() < 4096 + 1000 * scene->elements().size()) << count;
  }
}

}  // namespace
}  // namespace flatlight
