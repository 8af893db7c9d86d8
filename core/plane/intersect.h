// SPDX-License-Identifier: Apache-2.0
// Where a line meets one element. Distances are in units of the direction's length.
#ifndef FLATLIGHT_CORE_PLANE_INTERSECT_H_
#define FLATLIGHT_CORE_PLANE_INTERSECT_H_

#include <algorithm>
#include <cmath>

#include "core/math/vec.h"
#include "core/scene/scene.h"

namespace flatlight {

// Up to two crossings, nearest first.
struct Crossings {
  int count = 0;
  double t[2] = {0, 0};
};

// The line origin + t direction, made ready to meet many segments.
struct Line {
  Point2 origin;
  Vector2 direction;
  double length;
  double inverse_length_squared;
  double slack;  // The distance `touch`, in units of Cross(direction, .).

  Line(Point2 from, Vector2 along, double touch)
      : origin(from),
        direction(along),
        length(Length(along)),
        inverse_length_squared(1 / LengthSquared(along)),
        slack(touch * length) {}
};

// Whether a line meets the segment from a to b, and if so where: t of any sign. Ends count as part of it, to the
// distance `touch`; segments that share an end point, bit for bit, leave no gap between them.
inline bool MeetsSegment(const Line& line, Point2 segment_a, Point2 segment_b, double& t) {
  const Vector2 a = segment_a - line.origin;
  const Vector2 b = segment_b - line.origin;
  // On which side of the line each end lies: the same arithmetic for every element that shares the end.
  const double side_a = Cross(line.direction, a);
  const double side_b = Cross(line.direction, b);
  const double to_a = Dot(a, line.direction) * line.inverse_length_squared;
  const double to_b = Dot(b, line.direction) * line.inverse_length_squared;
  const Vector2 along = segment_b - segment_a;
  const double denominator = Cross(line.direction, along);
  const double near = std::min(to_a, to_b);
  const double crossing = denominator != 0 ? Cross(a, along) / denominator : near;
  t = std::min(std::max(crossing, near), std::max(to_a, to_b));
  return (std::min(side_a, side_b) <= line.slack) & (std::max(side_a, side_b) >= -line.slack);
}

// All crossings of the line origin + t direction, t of any sign. Ends count as part of the element, to the distance
// `touch`.
Crossings CrossSegment(const Element& segment, Point2 origin, Vector2 direction, double touch);
Crossings CrossArc(const Element& arc, Point2 origin, Vector2 direction, double touch);

// For an origin on the arc's own circle: the one other crossing of the circle, if the arc is there.
Crossings CrossOwnCircle(const Element& arc, Point2 on_circle, Vector2 direction, double touch);

// The points that two elements have in common, overlaps aside.
struct ElementCrossings {
  int count = 0;
  Point2 point[2];
};
ElementCrossings CrossElements(const Element& e, const Element& f, double touch);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_INTERSECT_H_
