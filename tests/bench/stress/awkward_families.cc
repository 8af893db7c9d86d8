// SPDX-License-Identifier: Apache-2.0
// Families of scenes that strain coordinates: tiny beside huge, touching, in line, through one point.
#include <algorithm>
#include <cmath>

#include "tests/bench/stress/family_parts.h"

namespace flatlight::stress {
namespace {

Point2 Along(Point2 a, Point2 b, double share) { return a + share * (b - a); }

// A wide lamp above all, facing down, and a floor below all, facing up.
void AddLampAndFloor(Pieces& pieces) {
  pieces.Segment({2, 1.5}, {-2, 1.5}, Pieces::Lamp());
  pieces.Segment({-2, -1.5}, {2, -1.5}, Pieces::Dark());
}

SceneDescription PencilOf(Random& random, int count) {
  Pieces pieces(random);
  AddLampAndFloor(pieces);
  const Point2 center = random.Chance(0.5) ? Point2{} : random.Point();
  for (int i = 0; i < count; ++i) {
    const Vector2 v = random.Uniform(0.1, 0.9) * random.Direction();
    pieces.Segment(random.Chance(0.5) ? center : center - v, center + v,
                   random.Chance(0.1) ? pieces.AnyLook() : Look{});
  }
  pieces.FreePoint(center, random.Direction());
  pieces.FreePoint(center + random.Size(-9, -1) * random.Direction(), random.Direction());
  pieces.ProbeCurve(1, 3, Side::kFront);
  return pieces.Take();
}

SceneDescription LineOf(Random& random, int count) {
  Pieces pieces(random);
  const bool gridded = random.Chance(0.5);
  const Point2 a = gridded ? Point2{-1, 0} : random.Point(), b = gridded ? Point2{1, 0} : random.Point();
  pieces.Segment({2, 1.5}, {-2, 1.5}, Pieces::TwoSided());
  for (int i = 0; i < count; ++i) {
    const double from = random.Next();
    pieces.Segment(Along(a, b, from), Along(a, b, from + random.Uniform(-0.1, 0.1)), Pieces::Dark());
  }
  pieces.ProbeCurve(0, 5, Side::kFront);
  pieces.ProbeCurves(4);
  pieces.FreePoint(Along(a, b, random.Next()), Left(b - a));
  return pieces.Take();
}

}  // namespace

// Some small curves close together beside some of ordinary size.
SceneDescription Cluster(Random& random) {
  Pieces pieces(random);
  AddLampAndFloor(pieces);
  const double size = random.Size(-9, -2);
  const Point2 place = random.Point();
  for (int i = random.Int(2, 7); i > 0; --i) {
    const Point2 at = place + size * (random.Point() - Point2{});
    if (random.Chance(0.3)) {
      const double radius = size * random.Uniform(0.1, 1);
      pieces.Arc(at, radius, random.Angle(), random.Sign() * random.Uniform(1, 2 * kPi), pieces.AnyLook());
    } else {
      pieces.Segment(at, at + size * random.Uniform(0.2, 2) * random.Direction(), pieces.AnyLook());
    }
  }
  for (int i = 0; i < 2; ++i) {
    const Point2 near = place + 2 * size * (random.Point() - Point2{});
    pieces.FreePoint(near, random.Direction());
  }
  pieces.ProbeCurves(4);
  pieces.FreePoints(1);
  return pieces.Take();
}

// Long and thin: nearly parallel walls a hair apart.
SceneDescription Slivers(Random& random) {
  Pieces pieces(random);
  AddLampAndFloor(pieces);
  const Point2 a = random.Point(), b = random.Point();
  const double apart = random.Size(-10, -1);
  const Vector2 aside = apart * Left(Normalized(b - a));
  for (int i = random.Int(2, 5); i > 0; --i) {
    const double from = random.Uniform(-1, 3), to = random.Uniform(-1, 3);
    pieces.Segment(Along(a, b, random.Uniform(0, 0.2)) + from * aside, Along(a, b, random.Uniform(0.8, 1)) + to * aside,
                   pieces.AnyLook());
  }
  if (random.Chance(0.5)) pieces.Polyline({a, b, b + aside, a + aside}, true, pieces.AnyLook());
  pieces.ProbeCurves(4);
  const Point2 between = Along(a, b, random.Next()) + random.Uniform(-1, 3) * aside;
  pieces.FreePoint(between, random.Direction());
  return pieces.Take();
}

// Through one point, to rounding or exactly.
SceneDescription Fan(Random& random) {
  Pieces pieces(random);
  const Point2 center = random.Chance(0.5) ? random.Point() : random.GridPoint(0.125);
  AddLampAndFloor(pieces);
  for (int i = random.Int(2, 9); i > 0; --i) {
    const Vector2 v = random.Uniform(0.1, 1) * random.Direction();
    const bool ends_there = random.Chance(0.4);
    if (random.Chance(0.2)) {
      const double radius = random.Uniform(0.1, 1), start = random.Angle();
      const SinCosValue turn = SinCos(start);
      pieces.Arc(center - radius * Vector2{turn.cos, turn.sin}, radius, start - (ends_there ? 0 : 0.5),
                 random.Uniform(1, 3), pieces.AnyLook());
    } else {
      pieces.Segment(ends_there ? center : center - random.Uniform(0.1, 1) * v, center + v, pieces.AnyLook());
    }
  }
  pieces.FreePoint(center, random.Direction());
  const Point2 near = center + random.Size(-12, 0) * random.Direction();
  pieces.FreePoint(near, random.Direction());
  pieces.ProbeCurves(3);
  return pieces.Take();
}

// On one line or circle, over one another in part.
SceneDescription Overlaps(Random& random) {
  Pieces pieces(random);
  const Point2 a = random.Point(), b = random.Point();
  const Point2 center = random.Point();
  const double radius = random.Uniform(0.1, 1);
  for (int i = random.Int(2, 8); i > 0; --i) {
    if (random.Chance(0.7)) {
      const double from = random.Int(0, 8) / 8.0, to = random.Int(0, 8) / 8.0;
      pieces.Segment(Along(a, b, from), Along(a, b, to), pieces.AnyLook());
    } else {
      pieces.Arc(center, radius, random.Int(-4, 4) * 0.5, random.Sign() * random.Int(1, 12) * 0.5, pieces.AnyLook());
    }
  }
  pieces.Segment(random.Point(), random.Point(), Pieces::TwoSided());
  pieces.ProbeCurves(4);
  const Point2 on = Along(a, b, random.Int(0, 16) / 16.0);
  pieces.FreePoint(on, random.Chance(0.5) ? Left(b - a) : random.Direction());
  return pieces.Take();
}

// Curves that end on others, at places that no double names.
SceneDescription Junctions(Random& random) {
  Pieces pieces(random);
  AddLampAndFloor(pieces);
  for (int i = random.Int(2, 8); i > 0; --i) {
    const auto host = static_cast<std::size_t>(random.Below(pieces.curves()));
    Point2 foot;
    if (const auto* segment = std::get_if<SegmentDescription>(&pieces.curve(host).shape)) {
      foot = Along(segment->a, segment->b, random.Next());
    } else {
      const auto& arc = std::get<ArcDescription>(pieces.curve(host).shape);
      const SinCosValue turn = SinCos(arc.start_angle + random.Next() * arc.sweep_angle);
      foot = arc.center + arc.radius * Vector2{turn.cos, turn.sin};
    }
    if (random.Chance(0.3)) {
      const double radius = random.Uniform(0.05, 0.8), start = random.Angle();
      const SinCosValue turn = SinCos(start);
      pieces.Arc(foot - radius * Vector2{turn.cos, turn.sin}, radius, start, random.Sign() * random.Uniform(0.5, 6),
                 pieces.AnyLook());
    } else {
      pieces.Segment(foot, foot + random.Uniform(0.05, 1) * random.Direction(), pieces.AnyLook());
    }
    if (random.Chance(0.3)) pieces.FreePoint(foot, random.Direction());
  }
  pieces.ProbeCurves(4);
  return pieces.Take();
}

// A room behind a wall with a gap that may be far smaller than anything else.
SceneDescription Keyhole(Random& random) {
  Pieces pieces(random);
  const double gap = random.Size(-9, 0) / 10, at = random.Uniform(-0.8, 0.8);
  pieces.Polyline({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, true, Pieces::Dark());
  pieces.Segment({-1, 0}, {at - gap / 2, 0}, Pieces::Dark());
  pieces.Segment({at + gap / 2, 0}, {1, 0}, Pieces::Dark());
  pieces.Segment({0.9, 0.9}, {-0.9, 0.9}, Pieces::Lamp(1));
  pieces.ProbeCurve(0, 9, Side::kFront);
  for (int i = 0; i < 3; ++i) {
    const double depth = -random.Size(-9, 0) / 10;
    const Point2 below{at + random.Uniform(-2, 2) * gap, depth};
    pieces.FreePoint(below, {random.Uniform(-1, 1), 1});
  }
  return pieces.Take();
}

// Of every size up to 1 : 1e9.
SceneDescription Sizes(Random& random) {
  Pieces pieces(random);
  for (int i = random.Int(2, 8); i > 0; --i) {
    const double size = random.Size(-9, 0);
    const Point2 place = random.Chance(0.5) ? random.Point() : Point2{} + size * (random.Point() - Point2{});
    if (random.Chance(0.4)) {
      pieces.Arc(place, size, random.Angle(), random.Sign() * random.Uniform(0.1, 2 * kPi), pieces.AnyLook());
    } else {
      pieces.Segment(place, place + size * random.Direction(), pieces.AnyLook());
    }
  }
  pieces.ProbeCurves(5);
  pieces.FreePoints(2);
  return pieces.Take();
}

// Nearly straight arcs of radius up to 1e9.
SceneDescription WideArcs(Random& random) {
  Pieces pieces(random);
  for (int i = random.Int(1, 4); i > 0; --i) {
    const double radius = random.Size(0, 9), length = random.Uniform(0.2, 2), middle = random.Angle();
    const SinCosValue turn = SinCos(middle);
    const Point2 center = random.Point() - radius * Vector2{turn.cos, turn.sin};
    const double sweep = random.Sign() * std::min(length / radius, 6.0);
    pieces.Arc(center, radius, middle - sweep / 2, sweep, pieces.AnyLook());
  }
  for (int i = random.Int(1, 4); i > 0; --i) {
    const Point2 a = random.Point();
    pieces.Segment(a, a + random.Uniform(0.1, 1) * random.Direction(), pieces.AnyLook());
  }
  pieces.ProbeCurves(4);
  pieces.FreePoints(2);
  return pieces.Take();
}

// Probes exactly on vertices, and beside them.
SceneDescription Corners(Random& random) {
  Pieces pieces(random);
  AddLampAndFloor(pieces);
  std::vector<Point2> corners;
  for (int i = random.Int(3, 6); i > 0; --i)
    corners.push_back(random.Chance(0.3) ? random.GridPoint(0.5) : random.Point());
  const bool closed = random.Chance(0.5);
  pieces.Polyline(corners, closed, pieces.AnyLook());
  // An angle of nearly zero.
  const Point2 tip = random.Point(), far = random.Point();
  pieces.Polyline({far, tip, far + random.Size(-12, 0) * random.Direction()}, false, pieces.AnyLook());
  pieces.FreePoint(tip, random.Direction());
  for (int i = 0; i < 4; ++i) {
    const Point2 corner = corners[random.Below(corners.size())];
    const Vector2 normal = random.Direction();
    pieces.FreePoint(corner, normal);
    pieces.FreePoint(corner + random.Size(-15, -1) * random.Direction(), normal);
  }
  pieces.ProbeCurves(2);
  return pieces.Take();
}

// Lamps and blockers that a receiver sees at its horizon.
SceneDescription Grazing(Random& random) {
  Pieces pieces(random);
  pieces.Segment({-1, 0}, {1, 0}, Pieces::Dark());
  for (int i = random.Int(1, 5); i > 0; --i) {
    const double x = random.Sign() * random.Uniform(0.5, 3), height = random.Sign() * random.Size(-14, 0) / 10;
    const Point2 low{x, random.Chance(0.3) ? 0 : height};
    if (random.Chance(0.25)) {
      const double radius = random.Uniform(0.05, 1);
      pieces.Arc(low + Vector2{0, random.Chance(0.5) ? radius : -radius}, radius, random.Angle(),
                 random.Sign() * random.Uniform(1, 2 * kPi), pieces.AnyLook());
    } else {
      const Vector2 v = random.Chance(0.5) ? Vector2{0, random.Size(-9, 0)} : random.Size(-9, 0) * random.Direction();
      pieces.Segment(low, low + v, pieces.AnyLook());
    }
  }
  pieces.Segment({2, 0}, {5, 0}, pieces.AnyLook());  // In line with the floor.
  pieces.ProbeCurve(0, 4, Side::kFront);
  pieces.ProbeCurve(0, 1, Side::kBack);
  const double x = random.Uniform(-1, 1);
  pieces.FreePoint({x, random.Size(-14, 0) / 10}, {0, 1});
  return pieces.Take();
}

// Circles that touch one another and lines, and arcs that end on the receiver.
SceneDescription Tangents(Random& random) {
  Pieces pieces(random);
  AddLampAndFloor(pieces);
  Point2 center = random.Point();
  double radius = random.Uniform(0.1, 0.6);
  for (int i = random.Int(2, 4); i > 0; --i) {
    pieces.Arc(center, radius, random.Angle(), random.Sign() * (random.Chance(0.6) ? 2 * kPi : random.Uniform(2, 6)),
               pieces.AnyLook());
    const Vector2 toward = random.Direction();
    const Point2 touch = center + radius * toward;
    if (random.Chance(0.3)) {
      pieces.Segment(touch - random.Uniform(0, 1) * Left(toward), touch + random.Uniform(0, 1) * Left(toward),
                     pieces.AnyLook());
    }
    if (random.Chance(0.5)) pieces.FreePoint(touch, random.Chance(0.5) ? toward : random.Direction());
    const double next = random.Uniform(0.05, 0.6);
    center = touch + (random.Chance(0.3) ? -next : next) * toward;
    radius = next;
  }
  // One that stands on the floor, and a dome whose end lies on it.
  const double x = random.Uniform(-1, 1), standing = random.Uniform(0.05, 0.5);
  pieces.Arc({x, -1.5 + standing}, standing, -kPi / 2, random.Sign() * random.Uniform(0.5, 2 * kPi), pieces.AnyLook());
  pieces.Arc({x, -1.5}, standing, 0, kPi, pieces.AnyLook());
  pieces.FreePoint({x, -1.5}, {0, 1});
  pieces.FreePoint({x + standing, -1.5}, {0, 1});
  pieces.ProbeCurve(1, 5, Side::kFront);
  pieces.ProbeCurves(3);
  return pieces.Take();
}

// Hundreds of curves through one point; thousands.
SceneDescription Pencil(Random& random) { return PencilOf(random, random.Int(50, 300)); }
SceneDescription WidePencil(Random& random) { return PencilOf(random, random.Int(1000, 4000)); }

// Hundreds of curves on one line, over one another; thousands.
SceneDescription OneLine(Random& random) { return LineOf(random, random.Int(50, 300)); }
SceneDescription WideLine(Random& random) { return LineOf(random, random.Int(1000, 4000)); }

}  // namespace flatlight::stress
