// SPDX-License-Identifier: Apache-2.0
// Families of scenes as people draw them: thrown about, on a grid, polygons, circles.
#include <cmath>

#include "tests/bench/stress/family_parts.h"

namespace flatlight::stress {
namespace {

constexpr double kEighth = 0.125;

void AddAny(Pieces& pieces, double longest) {
  Random& random = pieces.random();
  const Point2 place = random.Point();
  if (random.Chance(0.4)) {
    const double sweep = random.Chance(0.25) ? 2 * kPi : random.Uniform(0.1, 6.2);
    const double radius = random.Uniform(0.02, 0.4 * longest);
    const double start = random.Uniform(-7, 7);
    pieces.Arc(place, radius, start, random.Sign() * sweep, pieces.AnyLook());
  } else {
    const double length = random.Uniform(0.02, longest);
    pieces.Segment(place, place + length * random.Direction(), pieces.AnyLook());
  }
}

Vector2 GridDirection(Random& random) {
  constexpr Vector2 kDirections[] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}, {1, 1}, {-1, 1}, {1, -2}, {-3, -1}};
  return kDirections[random.Below(8)];
}

// Around a centre, in the order of the angle; convex if all radii are equal.
std::vector<Point2> Polygon(Random& random, Point2 center, double least, double most) {
  const int corners = random.Int(3, 8);
  const double start = random.Angle();
  std::vector<Point2> points;
  for (int i = 0; i < corners; ++i) {
    const SinCosValue turn = SinCos(start + 2 * kPi * (i + random.Uniform(0, 0.8)) / corners);
    const double radius = random.Uniform(least, most);
    points.push_back(center + radius * Vector2{turn.cos, turn.sin});
  }
  return points;
}

}  // namespace

SceneDescription Scatter(Random& random) {
  Pieces pieces(random);
  const int count = random.Int(1, 10);
  for (int i = 0; i < count; ++i) AddAny(pieces, 1.5);
  pieces.ProbeCurves(3);
  pieces.FreePoints(3);
  return pieces.Take();
}

SceneDescription Grid(Random& random) {
  Pieces pieces(random);
  const double step = random.Chance(0.5) ? kEighth : 0x1p-10;
  const int count = random.Int(2, 10);
  for (int i = 0; i < count; ++i) {
    if (random.Chance(0.3)) {
      std::vector<Point2> points;
      for (int k = random.Int(2, 5); k > 0; --k) points.push_back(random.GridPoint(step));
      pieces.Polyline(std::move(points), random.Chance(0.5), pieces.AnyLook());
    } else {
      const Point2 a = random.GridPoint(step);
      const Point2 b =
          random.Chance(0.5) ? random.GridPoint(step) : a + kEighth * random.Int(1, 6) * GridDirection(random);
      pieces.Segment(a, b, pieces.AnyLook());
    }
  }
  for (int i = 0; i < 4; ++i) {
    const Point2 position = random.GridPoint(step);
    pieces.FreePoint(position, GridDirection(random));
  }
  pieces.ProbeCurves(2);
  return pieces.Take();
}

SceneDescription GridArcs(Random& random) {
  Pieces pieces(random);
  const int count = random.Int(2, 6);
  for (int i = 0; i < count; ++i) {
    const Point2 place = random.GridPoint(kEighth);
    if (random.Chance(0.6)) {
      const double radius = kEighth * random.Int(1, 6);
      const double start = random.Int(-4, 4) * kPi / 2;
      pieces.Arc(place, radius, start, random.Sign() * random.Int(1, 4) * kPi / 2, pieces.AnyLook());
    } else {
      pieces.Segment(place, place + kEighth * random.Int(1, 8) * GridDirection(random), pieces.AnyLook());
    }
  }
  for (int i = 0; i < 4; ++i) {
    const Point2 position = random.GridPoint(kEighth);
    pieces.FreePoint(position, GridDirection(random));
  }
  pieces.ProbeCurves(2);
  return pieces.Take();
}

SceneDescription Polygons(Random& random) {
  Pieces pieces(random);
  pieces.Polyline(Polygon(random, {0, 0}, 1, random.Chance(0.5) ? 1 : 1.6), true, pieces.AnyLook());
  for (int i = random.Int(0, 4); i > 0; --i) {
    const double size = random.Uniform(0.02, 0.4);
    const Point2 center = random.Point();
    pieces.Polyline(Polygon(random, center, 0.3 * size, size), true, pieces.AnyLook());
  }
  if (random.Chance(0.7)) {
    const Point2 a = random.Point();
    pieces.Segment(a, a + 0.3 * random.Direction(), Pieces::TwoSided());
  }
  pieces.ProbeCurves(4);
  pieces.FreePoints(2);
  return pieces.Take();
}

SceneDescription Arcs(Random& random) {
  Pieces pieces(random);
  for (int i = random.Int(1, 6); i > 0; --i) {
    double sweep = random.Uniform(0, 2 * kPi);
    if (random.Chance(0.2)) sweep = random.Size(-9, 0) / 10;
    if (random.Chance(0.2)) sweep = 2 * kPi - random.Size(-9, 0) / 10;
    if (random.Chance(0.2)) sweep = random.Int(1, 4) * kPi / 2;
    const double radius = random.Chance(0.3) ? random.Size(-6, 0) : random.Uniform(0.05, 0.9);
    const Point2 center = random.Point();
    const double start = random.Chance(0.1) ? random.Uniform(-1e6, 1e6) : random.Uniform(-7, 7);
    pieces.Arc(center, radius, start, random.Sign() * std::max(sweep, 1e-9), pieces.AnyLook());
  }
  pieces.ProbeCurves(4);
  pieces.FreePoints(3);
  return pieces.Take();
}

// Waves, loops and near cusps, some with control points that coincide.
SceneDescription Beziers(Random& random) {
  Pieces pieces(random);
  const int count = random.Int(1, 5);
  for (int i = 0; i < count; ++i) {
    const Point2 place = random.Point();
    const double size = random.Chance(0.3) ? 0.1 : 0.8;
    const auto point = [&] { return place + size * (random.Point() - Point2{}); };
    BezierDescription bezier{point(), point(), point(), point()};
    if (random.Chance(0.1)) bezier.p1 = bezier.p0;
    if (random.Chance(0.1)) bezier.p2 = bezier.p3;
    pieces.Bezier(bezier, pieces.AnyLook());
  }
  for (int i = random.Int(0, 3); i > 0; --i) AddAny(pieces, 1.5);
  pieces.ProbeCurves(3);
  pieces.FreePoints(3);
  return pieces.Take();
}

SceneDescription Nested(Random& random) {
  Pieces pieces(random);
  const Point2 center = Point2{} + 0.3 * random.Next() * (random.Point() - Point2{});
  double radius = 1;
  for (int i = random.Int(2, 5); i > 0; --i, radius *= random.Uniform(0.5, 0.999999)) {
    if (random.Chance(0.5)) {
      pieces.Arc(center, radius, random.Angle(), random.Sign() * (random.Chance(0.5) ? 2 * kPi : random.Uniform(3, 6)),
                 pieces.AnyLook());
    } else {
      pieces.Polyline(Polygon(random, center, radius, radius), true, pieces.AnyLook());
    }
  }
  pieces.ProbeCurves(4);
  pieces.FreePoints(2);
  return pieces.Take();
}

SceneDescription Crowd(Random& random) {
  Pieces pieces(random);
  const int count = random.Int(50, 400);
  const double size = 2 / std::sqrt(count);
  const bool gridded = random.Chance(0.3);
  for (int i = 0; i < count; ++i) {
    if (gridded) {
      const Point2 a = random.GridPoint(kEighth);
      pieces.Segment(a, a + kEighth * random.Int(1, 3) * GridDirection(random), pieces.AnyLook());
    } else {
      AddAny(pieces, size);
    }
  }
  pieces.ProbeCurves(3);
  pieces.FreePoints(2);
  return pieces.Take();
}

}  // namespace flatlight::stress
