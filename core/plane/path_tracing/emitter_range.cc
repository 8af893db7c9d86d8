// SPDX-License-Identifier: Apache-2.0
#include "core/plane/path_tracing/emitter_range.h"

#include <algorithm>
#include <cmath>

#include "core/math/tolerances.h"
#include "core/plane/shaft.h"

namespace flatlight {
namespace {

using Kind = EmitterRange::Kind;

// From a direction to the horizon beside it: to sine +1 (upper) or -1. Without cancellation.
EmitterRange ToHorizon(double sine, double cosine, bool upper) {
  const double toward = upper ? sine : -sine;
  const double width = toward > 0 ? cosine * cosine / (1 + toward) : 1 - toward;
  return {width > 0 ? Kind::kSines : Kind::kNone, false, false, upper ? sine : -1, width};
}

// The sines between two points, seen from the vertex less than a half turn apart; cut at the horizon.
EmitterRange Between(Point2 p, Point2 q, const Vertex& vertex) {
  const Vector2 a = p - vertex.at.position;
  const Vector2 b = q - vertex.at.position;
  const double height_a = Dot(vertex.normal, a);
  const double height_b = Dot(vertex.normal, b);
  if (height_a <= 0 && height_b <= 0) return {};
  const Vector2 tangent = vertex.Tangent();
  const double length_a = Length(a);
  const double length_b = Length(b);
  const double sine_a = std::clamp(Dot(tangent, a) / length_a, -1.0, 1.0);
  const double sine_b = std::clamp(Dot(tangent, b) / length_b, -1.0, 1.0);
  if (height_a <= 0 || height_b <= 0) {
    // The line between them crosses the horizon on one side.
    const double crossing = Dot(tangent, a) * height_b - Dot(tangent, b) * height_a;
    return height_b > 0 ? ToHorizon(sine_b, height_b / length_b, crossing > 0)
                        : ToHorizon(sine_a, height_a / length_a, crossing < 0);
  }
  // A difference of sines free of cancellation (THEORY 18 B2). Its denominator vanishes only where the plain difference
  // is as good.
  const double product = length_a * length_b;
  const double denominator = product + Dot(a, b);
  const double width = denominator < 0.125 * product
                           ? std::abs(sine_b - sine_a)
                           : std::abs(Cross(a, q - p)) * (height_a / length_a + height_b / length_b) / denominator;
  return {width > 0 ? Kind::kSines : Kind::kNone, false, false, std::min(sine_a, sine_b), width};
}

EmitterRange SegmentRange(const Element& segment, EmittingSides sides, const Vertex& vertex) {
  if (vertex.carrier == segment.carrier) return {};
  // Positive where the vertex lies on the left, which is the front.
  const double facing = Cross(segment.b - segment.a, vertex.at.position - segment.a);
  if (facing == 0 || (facing < 0 && sides == EmittingSides::kFront)) return {};
  EmitterRange range = Between(segment.a, segment.b, vertex);
  range.alone = true;
  return range;
}

// A positive guess at the sines that an arc covers: its length over its distance, at most all. None if all of it is
// below the horizon.
EmitterRange ByLength(const Element& arc, const Vertex& vertex) {
  const Corners corners = CornersOf(arc);
  const auto below = [&](Point2 p) { return Dot(vertex.normal, p - vertex.at.position) <= 0; };
  if (std::all_of(corners.point.begin(), corners.point.begin() + 3, below)) return {};
  const double distance = Length(arc.a + 0.5 * (arc.b - arc.a) - vertex.at.position);
  return {Kind::kLength, false, false, -1, std::min(2.0, arc.length / distance)};
}

EmitterRange ArcRangeFromInside(const Element& arc, EmittingSides sides, const Vertex& vertex) {
  if (arc.Orientation() < 0 && sides == EmittingSides::kFront) return {};
  // Between the arc and its chord the arc fills more than a half turn; on the chord, too, its ends may lie at the
  // horizon or below it though all else is above.
  const Vector2 chord = arc.b - arc.a;
  const double beyond_chord = arc.Orientation() * Cross(chord, vertex.at.position - arc.a);
  if (!(beyond_chord > 4 * kTouchDistance * Length(chord))) return ByLength(arc, vertex);
  EmitterRange range = Between(arc.a, arc.b, vertex);
  range.far = true;
  range.alone = true;
  return range;
}

EmitterRange ArcRangeFromOutside(const Element& arc, EmittingSides sides, const Vertex& vertex) {
  const Vector2 from_center = vertex.at.position - arc.center;
  const double distance = Length(from_center);
  const bool outer = arc.Orientation() < 0 || sides == EmittingSides::kBoth;
  const bool inner = arc.Orientation() > 0 || sides == EmittingSides::kBoth;
  // Which of its ends show their outer side.
  const bool outer_a = Dot(arc.radial_a, from_center) > arc.radius;
  const bool outer_b = Dot(arc.radial_b, from_center) > arc.radius;
  const double turn = arc.Orientation();
  const bool nearest_inside =
      turn * Cross(arc.radial_a, from_center) >= 0 && turn * Cross(from_center, arc.radial_b) >= 0;
  EmitterRange range;
  if (outer_a && outer_b) {
    if (outer) range = Between(arc.a, arc.b, vertex);
    range.alone = true;
    return range;
  }
  if (!outer_a && !outer_b && !nearest_inside) {
    if (inner) range = Between(arc.a, arc.b, vertex);
    range.far = true;
    return range;
  }
  // One or both silhouettes, where rays touch the circle, lie on the arc.
  if ((outer && inner) || (inner && outer_a == outer_b)) return ByLength(arc, vertex);
  const double cosine = arc.radius / distance;
  const Vector2 middle = (arc.radius * cosine / distance) * from_center;
  const Vector2 side = (turn * arc.radius * CosineOf(std::min(cosine, 1.0)) / distance) * Left(from_center);
  const Point2 silhouette_a = arc.center + (middle - side);  // Before the nearest point, in the sense of the arc.
  const Point2 silhouette_b = arc.center + (middle + side);
  if (outer) {
    range = Between(outer_a ? arc.a : silhouette_a, outer_b ? arc.b : silhouette_b, vertex);
    range.alone = true;
    return range;
  }
  range = outer_a ? Between(silhouette_b, arc.b, vertex) : Between(arc.a, silhouette_a, vertex);
  range.far = true;
  return range;
}

}  // namespace

EmitterRange RangeOf(const Element& element, EmittingSides sides, const Vertex& vertex) {
  if (element.kind == Element::Kind::kSegment) return SegmentRange(element, sides, vertex);
  const Vector2 from_center = vertex.at.position - element.center;
  // On the circle itself the side is known, whatever the rounding of the position.
  if (vertex.carrier == element.carrier) {
    if (Dot(vertex.normal, from_center) > 0) return {};
    return ArcRangeFromInside(element, sides, vertex);
  }
  return LengthSquared(from_center) > element.radius * element.radius ? ArcRangeFromOutside(element, sides, vertex)
                                                                      : ArcRangeFromInside(element, sides, vertex);
}

Point2 PointInDirection(const Element& element, const EmitterRange& range, const Vertex& vertex, Vector2 direction) {
  if (element.kind == Element::Kind::kSegment) {
    const Vector2 along = element.b - element.a;
    const double across = Cross(along, direction);
    const double place = across == 0 ? 0.5 : Cross(direction, element.a - vertex.at.position) / across;
    return element.a + std::clamp(place, 0.0, 1.0) * along;
  }
  const Vector2 toward = element.center - vertex.at.position;
  const double offset = Cross(toward, direction);
  const double half_chord = std::sqrt(std::max((element.radius - offset) * (element.radius + offset), 0.0));
  return vertex.at.position + (Dot(toward, direction) + (range.far ? half_chord : -half_chord)) * direction;
}

}  // namespace flatlight
