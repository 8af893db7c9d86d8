// SPDX-License-Identifier: Apache-2.0
#include "core/scene/element_frame.h"

#include <algorithm>
#include <cmath>

#include "core/math/trig.h"

namespace flatlight {

ElementFrame FrameAt(const Element& element, double fraction) {
  ElementFrame frame;
  if (element.kind == Element::Kind::kSegment) {
    const Vector2 along = element.b - element.a;
    frame.position = fraction <= 0.5 ? element.a + fraction * along : element.b - (1 - fraction) * along;
    frame.tangent = Normalized(along);
    frame.normal = Left(frame.tangent);
    return frame;
  }
  // By the chord from a, whose length 2 r sin(phi/2) keeps its digits however large the radius is.
  const SinCosValue half = SinCos(0.5 * fraction * element.sweep_angle);
  const auto turn = [&](Vector2 v) { return half.cos * v + half.sin * Left(v); };
  const Vector2 middle = turn(element.radial_a);
  const Vector2 radial = turn(middle);
  frame.position = element.a + 2 * element.radius * half.sin * Left(middle);
  const double orientation = element.Orientation();
  frame.tangent = orientation * Left(radial);
  frame.normal = Left(frame.tangent);
  frame.curvature = orientation / element.radius;
  return frame;
}

double FractionAt(const Element& element, Point2 on_element) {
  double fraction;
  if (element.kind == Element::Kind::kSegment) {
    const Vector2 along = element.b - element.a;
    fraction = Dot(on_element - element.a, along) / LengthSquared(along);
  } else {
    const Vector2 radial = element.radial_a + (on_element - element.a) / element.radius;
    fraction = AngleOf(Dot(element.radial_a, radial), std::abs(Cross(element.radial_a, radial))) /
               std::abs(element.sweep_angle);
  }
  return std::clamp(fraction, 0.0, 1.0);
}

Vector2 FrontNormal(const Element& element, Point2 on_element) {
  if (element.kind == Element::Kind::kSegment) return Left(Normalized(element.b - element.a));
  // The gradient of the circle's equation written about a: exact as the radius grows.
  const Vector2 outward = element.radial_a + (on_element - element.a) / element.radius;
  return -element.Orientation() * Normalized(outward);
}

double DistanceTo(const Element& element, Point2 p) {
  const Vector2 along = element.b - element.a;
  const Vector2 from_a = p - element.a;
  const double t = Dot(from_a, along) / LengthSquared(along);
  // Beyond an end (an arc of at most a quarter lies between the perpendiculars on its chord's ends).
  if (t <= 0) return Length(from_a);
  if (t >= 1) return Length(p - element.b);
  const double side = Cross(along, from_a) / Length(along);
  if (element.kind == Element::Kind::kSegment) return std::abs(side);
  // On the chord's empty side, beyond the radii to the ends, an end is nearest.
  const Vector2 from_center = element.radial_a + from_a / element.radius;
  const double turn = element.Orientation();
  if (side * turn > 0 &&
      (turn * Cross(element.radial_a, from_center) < 0 || turn * Cross(from_center, element.radial_b) < 0)) {
    return std::min(Length(from_a), Length(p - element.b));
  }
  // The circle's equation about a, q.u + |q|^2/(2 r), is the distance to first order.
  return std::abs(Dot(from_a, element.radial_a) + LengthSquared(from_a) / (2 * element.radius));
}

}  // namespace flatlight
