// SPDX-License-Identifier: Apache-2.0
#include "core/plane/intersect.h"

#include <algorithm>
#include <cmath>

namespace flatlight {
namespace {

// Whether a point of the circle belongs to the arc. An arc of at most a quarter is the part of its circle between the
// perpendiculars on its chord's ends and on the chord's outer side.
bool OnArc(const Element& arc, Vector2 from_a, double touch) {
  const Vector2 chord = arc.b - arc.a;
  const double length = Length(chord);
  const double along = Dot(from_a, chord);
  const double slack = touch * length;
  return along >= -slack && along <= length * length + slack &&
         arc.Orientation() * Cross(chord, from_a) <= slack + 1e-9 * length * arc.length;
}

void Keep(const Element& arc, Vector2 origin_from_a, Vector2 direction, double t, double touch, Crossings& crossings) {
  if (OnArc(arc, origin_from_a + t * direction, touch)) crossings.t[crossings.count++] = t;
}

}  // namespace

Crossings CrossSegment(const Element& segment, Point2 origin, Vector2 direction, double touch) {
  Crossings crossings;
  if (MeetsSegment(Line(origin, direction, touch), segment.a, segment.b, crossings.t[0])) crossings.count = 1;
  return crossings;
}

Crossings CrossArc(const Element& arc, Point2 origin, Vector2 direction, double touch) {
  // The circle's equation about the arc's end a, with q = p - a and u the outward normal there:
  // q.u + |q|^2/(2 r) = 0. It loses no digits as r grows; with p on the line it reads A t^2/2 + B t + C = 0.
  const Vector2 q = origin - arc.a;
  const double bend = 1 / arc.radius;
  const double a = bend * LengthSquared(direction);
  const Vector2 v = arc.radial_a + bend * q;  // From the centre, in radii.
  const double b = Dot(direction, v);
  const double c = Dot(q, arc.radial_a) + 0.5 * bend * LengthSquared(q);
  // From far away by the line's offset from the centre, in which nothing cancels.
  const double length = Length(direction);
  const double offset = Cross(direction, v);
  const double discriminant = 2 * bend * c > 1 ? (length - offset) * (length + offset) : b * b - 2 * a * c;
  if (discriminant < 0) return {};
  const double root = -b - std::copysign(std::sqrt(discriminant), b);
  Crossings crossings;
  if (root == 0) {
    Keep(arc, q, direction, 0, touch, crossings);
    return crossings;
  }
  const double t0 = root / a;
  const double t1 = 2 * c / root;
  Keep(arc, q, direction, std::min(t0, t1), touch, crossings);
  if (t0 != t1) Keep(arc, q, direction, std::max(t0, t1), touch, crossings);
  return crossings;
}

ElementCrossings CrossElements(const Element& e, const Element& f, double touch) {
  ElementCrossings common;
  if (e.kind == Element::Kind::kArc && f.kind == Element::Kind::kArc) {
    // Both circles written about an end each: E(q) = q.u + |q|^2/(2 r) = 0 with q = p - e.a, and the same for f. What
    // is left of E/r_f - F/r_e is the line through their common points, m.q = k: no digits are lost as a radius grows.
    const double bend_e = 1 / e.radius, bend_f = 1 / f.radius;
    const Vector2 d = f.a - e.a;
    const Vector2 m = bend_f * e.radial_a - bend_e * f.radial_a + (bend_e * bend_f) * d;
    const double squared = LengthSquared(m);
    if (squared == 0) return {};
    const double k = bend_e * (0.5 * bend_f * LengthSquared(d) - Dot(d, f.radial_a));
    const Point2 origin = e.a + k / squared * m;
    const Vector2 along = Left(m) / std::sqrt(squared);
    const Crossings crossings = CrossArc(e.radius < f.radius ? e : f, origin, along, touch);
    for (int i = 0; i < crossings.count; ++i) {
      const Point2 point = origin + crossings.t[i] * along;
      if (OnArc(e, point - e.a, touch) && OnArc(f, point - f.a, touch)) common.point[common.count++] = point;
    }
    return common;
  }
  const Element& line = e.kind == Element::Kind::kSegment ? e : f;
  const Element& other = e.kind == Element::Kind::kSegment ? f : e;
  const Vector2 direction = line.b - line.a;
  const Crossings crossings = other.kind == Element::Kind::kSegment ? CrossSegment(other, line.a, direction, touch)
                                                                    : CrossArc(other, line.a, direction, touch);
  for (int i = 0; i < crossings.count; ++i) {
    const double t = crossings.t[i];
    if (t >= 0 && t <= 1) common.point[common.count++] = line.a + t * direction;
  }
  return common;
}

Crossings CrossOwnCircle(const Element& arc, Point2 on_circle, Vector2 direction, double touch) {
  const Vector2 q = on_circle - arc.a;
  const double bend = 1 / arc.radius;
  const Vector2 outward = Normalized(arc.radial_a + bend * q);
  Crossings crossings;
  Keep(arc, q, direction, -2 * Dot(direction, outward) / (bend * LengthSquared(direction)), touch, crossings);
  return crossings;
}

}  // namespace flatlight
