// SPDX-License-Identifier: Apache-2.0
#include "core/scene/element_frame.h"

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

Vector2 FrontNormal(const Element& element, Point2 on_element) {
  if (element.kind == Element::Kind::kSegment) return Left(Normalized(element.b - element.a));
  // The gradient of the circle's equation written about a: exact as the radius grows.
  const Vector2 outward = element.radial_a + (on_element - element.a) / element.radius;
  return -element.Orientation() * Normalized(outward);
}

}  // namespace flatlight
