// SPDX-License-Identifier: Apache-2.0
#include "core/plane/triangulation/mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "core/math/vec.h"
#include "core/plane/triangulation/predicates.h"

namespace flatlight {
namespace {

constexpr double kWeld = 0x1p-50;

// That it is a triangulation of the square, and that no free edge should be flipped.
void ExpectSound(const Mesh& mesh) {
  EXPECT_EQ(mesh.triangles(), 2 * mesh.points().size() - 6) << "by Euler's formula, for four corners";
  double area = 0;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (Mesh::Side s = 0; s < 3 * mesh.triangles(); ++s) {
    const Point2 a = mesh.At(mesh.Opposite(s)), b = mesh.At(mesh.From(s)), c = mesh.At(mesh.To(s));
    ASSERT_EQ(Orientation(a, b, c), 1);
    area += Cross(b - a, c - a) / 6;  // Thrice for each triangle, half the parallelogram.
    ASSERT_TRUE(edges.insert({mesh.From(s), mesh.To(s)}).second) << "two triangles on one side of an edge";
    const Mesh::Side twin = mesh.Twin(s);
    if (twin == Mesh::kNone) {
      EXPECT_LT(mesh.From(s), 4u) << "at the border";
      EXPECT_LT(mesh.To(s), 4u) << "at the border";
      continue;
    }
    ASSERT_EQ(mesh.Twin(twin), s);
    ASSERT_EQ(mesh.From(twin), mesh.To(s));
    ASSERT_EQ(mesh.To(twin), mesh.From(s));
    ASSERT_EQ(mesh.Mark(twin), mesh.Mark(s));
    EXPECT_FALSE(mesh.Mark(s) == Mesh::kNone && IsInsideCircle(a, b, c, mesh.At(mesh.Opposite(twin))));
  }
  EXPECT_NEAR(area, 16, 1e-10);
}

class Random {
 public:
  double Next() { return static_cast<double>(engine_() >> 11) * 0x1p-52 - 1; }
  Point2 Point() { return {Next(), Next()}; }
  // A place of a grid of 2^-3.
  Point2 GridPoint() { return {std::round(8 * Next()) / 8, std::round(8 * Next()) / 8}; }

 private:
  std::mt19937_64 engine_{3};
};

// Connects two vertices, cutting at vertices on the way; leaves it where a marked edge crosses. Returns whether it came
// through.
bool ConnectAll(Mesh& mesh, Mesh::Vertex from, Mesh::Vertex to, std::uint32_t mark) {
  if (from == to) return true;
  const Mesh::Way way = mesh.Trace(from, to);
  switch (way.kind) {
    case Mesh::Way::Kind::kEdge:
      mesh.SetMark(way.side, mark);
      return true;
    case Mesh::Way::Kind::kFree: {
      const auto side = mesh.Connect(from, to);
      EXPECT_TRUE(side);
      mesh.SetMark(*side, mark);
      EXPECT_EQ(std::minmax(mesh.From(*side), mesh.To(*side)), std::minmax(from, to));
      return true;
    }
    case Mesh::Way::Kind::kVertex:
      return ConnectAll(mesh, from, way.vertex, mark) && ConnectAll(mesh, way.vertex, to, mark);
    case Mesh::Way::Kind::kMarked:
      EXPECT_NE(mesh.Mark(way.side), Mesh::kNone);
      return false;
  }
  return false;
}

TEST(MeshTest, NoPointLiesInATrianglesCircle) {
  Random random;
  for (const bool grid : {false, true}) {
    Mesh mesh(2, kWeld);
    for (int i = 0; i < 300; ++i) ASSERT_TRUE(mesh.Insert(grid ? random.GridPoint() : random.Point()));
    ExpectSound(mesh);
    for (Mesh::Side s = 0; s < 3 * mesh.triangles(); s += 3) {
      for (const Point2 p : mesh.points()) {
        ASSERT_FALSE(IsInsideCircle(mesh.At(mesh.Opposite(s)), mesh.At(mesh.From(s)), mesh.At(mesh.To(s)), p));
      }
    }
  }
}

TEST(MeshTest, PointsThatAreOneAreOneVertex) {
  Mesh mesh(2, kWeld);
  const Point2 p{0.25, 0.5};
  const auto v = mesh.Insert(p);
  EXPECT_EQ(mesh.Insert(p), v);
  EXPECT_EQ(mesh.Insert({p.x, p.y + 0.5 * kWeld}), v);
  EXPECT_NE(mesh.Insert({p.x, p.y + 2 * kWeld}), v);
  EXPECT_EQ(mesh.points().size(), 6u);
  ExpectSound(mesh);
  EXPECT_FALSE(mesh.Insert({3, 0})) << "outside";
}

TEST(MeshTest, PointsOfALineAndOfACircle) {
  Mesh mesh(2, kWeld);
  for (int i = 0; i < 200; ++i) mesh.Insert({i * 0.005 - 0.5, 0.25});
  for (int i = 0; i < 200; ++i) mesh.Insert({0.9 * std::cos(0.0314 * i), 0.9 * std::sin(0.0314 * i)});
  for (int i = 0; i < 200; ++i) mesh.Insert({i * 0.003 - 0.5, 0.1 + 0.7 * (i * 0.003 - 0.5)});
  ExpectSound(mesh);
}

TEST(MeshTest, MarkedEdgesAreThereAndStay) {
  Random random;
  for (int round = 0; round < 40; ++round) {
    const bool grid = round % 2 == 0;
    Mesh mesh(2, kWeld);
    std::vector<Mesh::Vertex> vertices(120);
    for (Mesh::Vertex& v : vertices) v = mesh.Insert(grid ? random.GridPoint() : random.Point()).value();
    std::set<std::size_t> kept;
    for (std::size_t i = 0; i < 80; i += 2)
      if (ConnectAll(mesh, vertices[i], vertices[i + 1], static_cast<std::uint32_t>(i))) kept.insert(i);
    ExpectSound(mesh);
    // Later points leave them where they are.
    for (int i = 0; i < 60; ++i) mesh.Insert(grid ? random.GridPoint() : random.Point());
    ExpectSound(mesh);
    EXPECT_GT(kept.size(), 4u);
    for (const std::size_t i : kept) {
      // Edges from end to end, each with this mark or that of another one that lies over it.
      const Mesh::Way way = mesh.Trace(vertices[i], vertices[i + 1]);
      EXPECT_TRUE(vertices[i] == vertices[i + 1] || way.kind == Mesh::Way::Kind::kEdge ||
                  way.kind == Mesh::Way::Kind::kVertex);
    }
  }
}

TEST(MeshTest, ALongEdgeThroughManyTriangles) {
  Random random;
  Mesh mesh(2, kWeld);
  for (int i = 0; i < 5000; ++i) mesh.Insert(random.Point());
  const Mesh::Vertex a = mesh.Insert({-0.99, -0.31}).value(), b = mesh.Insert({0.99, 0.33}).value();
  EXPECT_EQ(mesh.Trace(a, b).kind, Mesh::Way::Kind::kFree);
  const auto side = mesh.Connect(a, b);
  ASSERT_TRUE(side);
  mesh.SetMark(*side, 7);
  EXPECT_EQ(mesh.Trace(a, b).kind, Mesh::Way::Kind::kEdge);
  ExpectSound(mesh);
}

TEST(MeshTest, AWayMeetsVerticesWithinTheWeldAndMarkedEdges) {
  Mesh mesh(2, kWeld);
  const Mesh::Vertex a = mesh.Insert({-0.5, 0}).value(), b = mesh.Insert({0.5, 0}).value();
  const Mesh::Vertex c = mesh.Insert({0.125, 0.9 * kWeld}).value();
  EXPECT_EQ(mesh.Trace(a, b).kind, Mesh::Way::Kind::kVertex);
  EXPECT_EQ(mesh.Trace(a, b).vertex, c);
  const Mesh::Vertex d = mesh.Insert({0, 0.5}).value(), e = mesh.Insert({0, -0.5}).value();
  ASSERT_EQ(mesh.Trace(d, e).kind, Mesh::Way::Kind::kFree);
  mesh.SetMark(mesh.Connect(d, e).value(), 3);
  const Mesh::Way way = mesh.Trace(a, c);
  EXPECT_EQ(way.kind, Mesh::Way::Kind::kMarked);
  EXPECT_EQ(mesh.Mark(way.side), 3u);
}

}  // namespace
}  // namespace flatlight
