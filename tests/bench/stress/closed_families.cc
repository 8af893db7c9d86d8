// SPDX-License-Identifier: Apache-2.0
// Rooms that light cannot enter, with lamps outside. Turned and shifted any way, inside all must be black.
#include <algorithm>
#include <cmath>

#include "tests/bench/stress/family_parts.h"

namespace flatlight::stress {
namespace {

struct Pose {
  Point2 center;
  Vector2 turn;
  Point2 At(double x, double y) const { return center + x * turn + y * Left(turn); }
};

Pose AnyPose(Random& random) {
  const double far = random.Chance(0.3) ? random.Size(0, 9) : random.Uniform(0, 1);
  const Point2 center = Point2{} + far * random.Direction();
  return {center, random.Direction()};
}

void AddLampsOutside(Pieces& pieces, const Pose& pose) {
  Random& random = pieces.random();
  pieces.Arc(pose.center, 3, random.Angle(), 2 * kPi, Pieces::Lamp());
  pieces.Segment(pose.At(-1, 2), pose.At(1, 2.2), Pieces::TwoSided());
}

void AddProbesInside(Pieces& pieces, const Pose& pose, double reach) {
  Random& random = pieces.random();
  for (int i = 0; i < 4; ++i) {
    const double x = reach * random.Uniform(-1, 1);
    const Point2 place = pose.At(x, reach * random.Uniform(-1, 1));
    pieces.FreePoint(place, random.Direction());
  }
}

}  // namespace

// One closed polyline, or segments that share corners.
SceneDescription ClosedRoom(Random& random) {
  Pieces pieces(random);
  const Pose pose = AnyPose(random);
  const int corners = random.Int(4, 9);  // Fewer may leave the middle outside.
  const double start = random.Angle();
  std::vector<Point2> room;
  for (int i = 0; i < corners; ++i) {
    const SinCosValue turn = SinCos(start + 2 * kPi * (i + random.Uniform(0, 0.4)) / corners);
    room.push_back(pose.At(turn.cos, turn.sin));
  }
  if (random.Chance(0.5)) {
    pieces.Polyline(room, true, Pieces::Dark());
  } else {
    for (int i = 0; i < corners; ++i) {
      const auto at = [&](int k) { return room[static_cast<std::size_t>(k % corners)]; };
      random.Chance(0.5) ? pieces.Segment(at(i), at(i + 1), Pieces::Dark())
                         : pieces.Segment(at(i + 1), at(i), Pieces::Dark());
    }
  }
  AddLampsOutside(pieces, pose);
  AddProbesInside(pieces, pose, 0.15);
  // On the walls, from inside.
  const auto side = std::holds_alternative<PolylineDescription>(pieces.curve(0).shape) ? Side::kFront : Side::kBack;
  if (side == Side::kFront) pieces.ProbeCurve(0, 7, side);
  return pieces.Take();
}

// Walls that end on the inside of others.
SceneDescription ClosedJunctions(Random& random) {
  Pieces pieces(random);
  const Pose pose = AnyPose(random);
  pieces.Segment(pose.At(-2, -1), pose.At(2, -1), Pieces::Dark());
  pieces.Segment(pose.At(2, 1), pose.At(-2, 1), Pieces::Dark());
  const auto at = [&](std::size_t host, double share) {
    const auto& segment = std::get<SegmentDescription>(pieces.curve(host).shape);
    return segment.a + share * (segment.b - segment.a);
  };
  const Point2 low_left = at(0, random.Uniform(0.3, 0.4)), high_left = at(1, random.Uniform(0.6, 0.7));
  const Point2 low_right = at(0, random.Uniform(0.6, 0.7)), high_right = at(1, random.Uniform(0.3, 0.4));
  pieces.Segment(high_left, low_left, Pieces::Dark());
  pieces.Segment(low_right, high_right, Pieces::Dark());
  AddLampsOutside(pieces, pose);
  AddProbesInside(pieces, pose, 0.3);
  pieces.ProbeCurve(2, 5, Side::kFront);
  pieces.ProbeCurve(3, 5, Side::kFront);
  return pieces.Take();
}

// Arcs that share ends, or an arc and its chord.
SceneDescription ClosedArcs(Random& random) {
  Pieces pieces(random);
  const Pose pose = AnyPose(random);
  const double start = random.Angle(), sweep = random.Uniform(0.3, 5.9);
  const SinCosValue first = SinCos(start), turn = SinCos(sweep);
  const auto on_circle = [&](double c, double s) { return pose.center + Vector2{c, s}; };
  if (random.Chance(0.5)) {
    pieces.Arc(pose.center, 1, start, sweep, Pieces::Dark());
    pieces.Arc(pose.center, 1, start, sweep - 2 * kPi, Pieces::Dark());
    AddProbesInside(pieces, pose, 0.6);
    pieces.ProbeCurve(0, 5, Side::kFront);
    pieces.ProbeCurve(1, 5, Side::kBack);
  } else {
    const Point2 a = on_circle(first.cos, first.sin);
    const Point2 b =
        on_circle(first.cos * turn.cos - first.sin * turn.sin, first.sin * turn.cos + first.cos * turn.sin);
    pieces.Arc(pose.center, 1, start, sweep, Pieces::Dark());
    pieces.Segment(b, a, Pieces::Dark());
    pieces.ProbeCurve(0, 9, Side::kFront);
    pieces.ProbeCurve(1, 9, Side::kFront);
  }
  AddLampsOutside(pieces, pose);
  return pieces.Take();
}

// A ring of Béziers that share ends, smooth or not.
SceneDescription ClosedBeziers(Random& random) {
  Pieces pieces(random);
  const Pose pose = AnyPose(random);
  const int count = random.Int(2, 5);
  const double start = random.Angle();
  const auto at = [&](double turns, double radius) {
    const SinCosValue turn = SinCos(start + 2 * kPi * turns / count);
    return pose.center + radius * Vector2{turn.cos, turn.sin};
  };
  for (int i = 0; i < count; ++i) {
    const double next = (i + 1) % count == 0 ? 0 : i + 1;
    pieces.Bezier(
        {at(i, 1), at(i + 0.33, random.Uniform(0.8, 1.6)), at(i + 0.67, random.Uniform(0.8, 1.6)), at(next, 1)},
        Pieces::Dark());
  }
  AddProbesInside(pieces, pose, 0.3);
  for (int i = 0; i < count; ++i) pieces.ProbeCurve(static_cast<std::size_t>(i), 5, Side::kFront);
  AddLampsOutside(pieces, pose);
  return pieces.Take();
}

}  // namespace flatlight::stress
