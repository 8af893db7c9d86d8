// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/chart.h"

#include <algorithm>
#include <cmath>

namespace flatlight {

Chart::Chart(const Element& element) : element_(&element), along_(element.b - element.a) {
  if (element.kind == Element::Kind::kSegment) return;
  half_tangent_ = Cross(element.radial_a, element.radial_b) / (1 + Dot(element.radial_a, element.radial_b));
  curvature_ = element.Orientation() / element.radius;
}

Chart::Place Chart::At(double u) const {
  Place place;
  const Element& e = *element_;
  if (e.kind == Element::Kind::kSegment) {
    place.position = u <= 0.5 ? e.a + u * along_ : e.b - (1 - u) * along_;
    place.tangent = along_ / e.length;
    place.speed = e.length;
    return place;
  }
  const double t = u * half_tangent_, scale = 1 / (1 + t * t);
  const Vector2 left = Left(e.radial_a);
  // From a along the chord, whose digits do not depend on the radius.
  place.position = e.a + (2 * e.radius * t * scale) * (left - t * e.radial_a);
  const Vector2 radial = scale * ((1 - t * t) * e.radial_a + (2 * t) * left);
  place.tangent = e.Orientation() * Left(radial);
  place.speed = 2 * e.radius * std::abs(half_tangent_) * scale;
  return place;
}

double Chart::Find(Point2 point) const {
  const Element& e = *element_;
  if (e.kind == Element::Kind::kSegment) {
    const Vector2 from_a = point - e.a, from_b = point - e.b;
    const double squared = LengthSquared(along_);
    const double u = Dot(from_a, along_) / squared;
    return u <= 0.5 ? u : 1 + Dot(from_b, along_) / squared;
  }
  const Vector2 v = e.radial_a + (point - e.a) / e.radius;
  return Cross(e.radial_a, v) / ((Length(v) + Dot(e.radial_a, v)) * half_tangent_);
}

double Chart::Roundness(Point2 x, double low, double high) const {
  if (element_->kind == Element::Kind::kSegment) {
    const Point2 a = At(low).position, b = At(high).position;
    return (Length(a - x) + Length(b - x)) / Length(b - a);
  }
  const auto from = [&](double real, double imaginary) {
    const double l = real - low, h = real - high, squared = imaginary * imaginary;
    return (std::sqrt(l * l + squared) + std::sqrt(h * h + squared)) / (high - low);
  };
  // The squared distance is a polynomial of second degree in t, the tangent of half the angle, over 1 + t^2.
  const Element& e = *element_;
  const Vector2 to_center = e.center - x;
  const double squared = LengthSquared(to_center), radius = e.radius;
  const double scale = squared + radius * radius - 2 * radius * Dot(to_center, e.radial_a);
  const double pole = from(0, 1 / half_tangent_);
  if (!(scale > 0)) return pole;
  const double real = -2 * radius * Dot(to_center, Left(e.radial_a)) / scale;
  const double imaginary = (squared - radius * radius) / scale;
  return std::min(pole, from(real / half_tangent_, imaginary / half_tangent_));
}

Receiver Chart::ReceiverAt(ElementId id, double u, Side side) const {
  const Place place = At(u);
  const double sign = side == Side::kFront ? 1 : -1;
  Receiver receiver;
  receiver.position = place.position;
  receiver.tangent = place.tangent;
  receiver.normal = sign * Left(place.tangent);
  receiver.curvature = sign * curvature_;
  receiver.element = id;
  return receiver;
}

}  // namespace flatlight
