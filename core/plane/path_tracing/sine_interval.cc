// SPDX-License-Identifier: Apache-2.0
#include "core/plane/path_tracing/sine_interval.h"

#include <algorithm>
#include <cmath>

namespace flatlight {
namespace {

// 1 - sine without cancellation.
double UpTo1(double sine, double cosine) { return sine > 0 ? cosine * cosine / (1 + sine) : 1 - sine; }

// From a direction to the horizon on its side: of sine +1 or -1.
SineInterval ToHorizon(double sine, double cosine, bool upper) {
  if (upper) return {sine, UpTo1(sine, cosine)};
  return {-1, UpTo1(-sine, cosine)};
}

bool OutsideOf(const Element& circle, const Vertex& vertex) {
  const Vector2 toward = circle.center - vertex.at.position;
  // On the circle itself the side is known exactly, whatever the position's rounding.
  if (vertex.carrier == circle.carrier) return Dot(vertex.normal, toward) < 0;
  return LengthSquared(toward) > circle.radius * circle.radius;
}

}  // namespace

SineInterval SegmentInterval(const Element& segment, EmittingSides sides, const Vertex& vertex) {
  if (vertex.carrier == segment.carrier) return {};
  const Vector2 a = segment.a - vertex.at.position;
  const Vector2 b = segment.b - vertex.at.position;
  const Vector2 along = segment.b - segment.a;
  // Positive where the vertex lies on the left of the segment, which is its front.
  const double facing = Cross(a, along);
  if (facing == 0 || (facing < 0 && sides == EmittingSides::kFront)) return {};
  const double height_a = Dot(vertex.normal, a);
  const double height_b = Dot(vertex.normal, b);
  if (height_a <= 0 && height_b <= 0) return {};
  const Vector2 tangent = vertex.Tangent();
  const double length_a = Length(a);
  const double length_b = Length(b);
  const double sine_a = std::clamp(Dot(tangent, a) / length_a, -1.0, 1.0);
  const double sine_b = std::clamp(Dot(tangent, b) / length_b, -1.0, 1.0);
  if (height_a <= 0 || height_b <= 0) {
    // One end lies below the horizon; the segment crosses it on one side.
    const double crossing = Dot(tangent, a) * height_b - Dot(tangent, b) * height_a;
    const bool upper = height_b > height_a ? crossing > 0 : crossing < 0;
    return height_b > 0 ? ToHorizon(sine_b, height_b / length_b, upper) : ToHorizon(sine_a, height_a / length_a, upper);
  }
  const double low = std::min(sine_a, sine_b);
  // A difference of sines free of cancellation (THEORY 18 B2); its denominator vanishes only for segments so close that
  // the plain difference is as good.
  const double product = length_a * length_b;
  const double denominator = product + Dot(a, b);
  if (denominator < 0.125 * product) return {low, std::abs(sine_b - sine_a)};
  return {low, std::abs(facing) * (height_a / length_a + height_b / length_b) / denominator};
}

SineInterval CircleInterval(const Element& circle, EmittingSides sides, const Vertex& vertex) {
  const bool outside = OutsideOf(circle, vertex);
  const bool front = outside == (circle.Orientation() < 0);
  if (!front && sides == EmittingSides::kFront) return {};
  if (!outside) return {-1, 2};
  if (vertex.carrier == circle.carrier) return {};
  const Vector2 toward = circle.center - vertex.at.position;
  const double distance = Length(toward);
  const double sine = Dot(vertex.Tangent(), toward) / distance;
  const double cosine = Dot(vertex.normal, toward) / distance;
  // Half the angle that the circle fills.
  const double half_sine = std::min(circle.radius / distance, 1.0);
  const double half_cosine = CosineOf(half_sine);
  const double upper_sine = sine * half_cosine + cosine * half_sine;
  const double upper_cosine = cosine * half_cosine - sine * half_sine;
  const double lower_sine = sine * half_cosine - cosine * half_sine;
  const double lower_cosine = cosine * half_cosine + sine * half_sine;
  if (upper_cosine <= 0 && lower_cosine <= 0) return {};
  if (upper_cosine <= 0) return ToHorizon(lower_sine, lower_cosine, true);
  if (lower_cosine <= 0) return ToHorizon(upper_sine, upper_cosine, false);
  return {lower_sine, 2 * cosine * half_sine};
}

Point2 PointOnSegment(const Element& segment, const Vertex& vertex, Vector2 direction) {
  const Vector2 along = segment.b - segment.a;
  const double across = Cross(along, direction);
  if (across == 0) return segment.a + 0.5 * along;
  const double place = Cross(direction, segment.a - vertex.at.position) / across;
  return segment.a + std::clamp(place, 0.0, 1.0) * along;
}

Point2 PointOnCircle(const Element& circle, const Vertex& vertex, Vector2 direction) {
  const Vector2 toward = circle.center - vertex.at.position;
  const double middle = Dot(toward, direction);
  const double offset = Cross(toward, direction);
  const double half_chord = std::sqrt(std::max((circle.radius - offset) * (circle.radius + offset), 0.0));
  const double distance = OutsideOf(circle, vertex) ? middle - half_chord : middle + half_chord;
  return vertex.at.position + distance * direction;
}

}  // namespace flatlight
