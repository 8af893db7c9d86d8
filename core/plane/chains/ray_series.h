// SPDX-License-Identifier: Apache-2.0
// Families of rays that depend on one number, as power series in it, on their way over mirrors and through glass.
// Where a step cannot be done for the ray itself, the series' constant terms, functions say so.
#ifndef FLATLIGHT_CORE_PLANE_CHAINS_RAY_SERIES_H_
#define FLATLIGHT_CORE_PLANE_CHAINS_RAY_SERIES_H_

#include <cmath>
#include <cstddef>
#include <optional>

#include "core/math/series.h"
#include "core/math/trig.h"
#include "core/math/vec.h"
#include "core/scene/scene.h"

namespace flatlight {

template <std::size_t n>
struct VectorSeries {
  Series<n> x, y;

  static VectorSeries Constant(Vector2 v) { return {Series<n>::Constant(v.x), Series<n>::Constant(v.y)}; }
  Vector2 Value() const { return {x[0], y[0]}; }
  friend VectorSeries operator+(const VectorSeries& u, const VectorSeries& v) { return {u.x + v.x, u.y + v.y}; }
  friend VectorSeries operator-(const VectorSeries& u, const VectorSeries& v) { return {u.x - v.x, u.y - v.y}; }
  friend VectorSeries operator*(const Series<n>& k, const VectorSeries& v) { return {k * v.x, k * v.y}; }
  friend VectorSeries operator*(double k, const VectorSeries& v) { return {k * v.x, k * v.y}; }
  friend Series<n> Dot(const VectorSeries& u, const VectorSeries& v) { return u.x * v.x + u.y * v.y; }
  friend Series<n> Cross(const VectorSeries& u, const VectorSeries& v) { return u.x * v.y - u.y * v.x; }
  friend VectorSeries Left(const VectorSeries& v) { return {-1.0 * v.y, v.x}; }
  friend VectorSeries Right(const VectorSeries& v) { return {v.y, -1.0 * v.x}; }
};

// d/du, known to one term less: the last is 0.
template <std::size_t n>
Series<n> Derived(const Series<n>& f) {
  Series<n> derivative;
  for (std::size_t k = 0; k + 1 < n; ++k) derivative[k] = static_cast<double>(k + 1) * f[k + 1];
  return derivative;
}
template <std::size_t n>
VectorSeries<n> Derived(const VectorSeries<n>& v) {
  return {Derived(v.x), Derived(v.y)};
}

template <std::size_t n>
VectorSeries<n> Normalized(const VectorSeries<n>& v) {
  return (Series<n>::Constant(1) / Sqrt(Dot(v, v))) * v;
}

// A place and a unit direction. Places are told from the origin of the scene.
template <std::size_t n>
struct RaySeries {
  VectorSeries<n> from;
  VectorSeries<n> direction;
};

// The place at the fraction u + x of an element's length, x the series' variable.
template <std::size_t n>
VectorSeries<n> PlaceOn(const Element& element, double u) {
  Series<n> fraction;
  fraction[0] = u;
  if (n > 1) fraction[1] = 1;
  const VectorSeries<n> a = VectorSeries<n>::Constant(element.a - Point2{});
  if (element.kind == Element::Kind::kSegment) return a + fraction * VectorSeries<n>::Constant(element.b - element.a);
  // By the chord from a, as FrameAt does.
  const double turn = 0.5 * element.sweep_angle;
  const SinCosValue half = SinCos(u * turn);
  Series<n> sine, cosine;
  double factor = 1;
  for (std::size_t k = 0; k < n; ++k) {
    constexpr double kSign[] = {1, 1, -1, -1};
    sine[k] = factor * kSign[k % 4] * (k % 2 == 0 ? half.sin : half.cos);
    cosine[k] = factor * kSign[(k + 1) % 4] * (k % 2 == 0 ? half.cos : half.sin);
    factor *= turn / static_cast<double>(k + 1);
  }
  const VectorSeries<n> radial = VectorSeries<n>::Constant(element.radial_a);
  const VectorSeries<n> middle = cosine * radial + sine * Left(radial);
  return a + (2 * element.radius) * (sine * Left(middle));
}

// Unit normal of the front at a place on the element.
template <std::size_t n>
VectorSeries<n> FrontOn(const Element& element, const VectorSeries<n>& place) {
  if (element.kind == Element::Kind::kSegment)
    return VectorSeries<n>::Constant(Left(Normalized(element.b - element.a)));
  const VectorSeries<n> outward = VectorSeries<n>::Constant(element.radial_a) +
                                  (1 / element.radius) * (place - VectorSeries<n>::Constant(element.a - Point2{}));
  return -element.Orientation() * Normalized(outward);
}

// How far a ray goes to the element's line or circle: to the second place where it meets the circle if `far`, or where
// it meets it again if it comes from there.
template <std::size_t n>
std::optional<Series<n>> DistanceTo(const Element& element, const RaySeries<n>& ray, bool far, bool from_own_circle) {
  const VectorSeries<n> q = ray.from - VectorSeries<n>::Constant(element.a - Point2{});
  if (element.kind == Element::Kind::kSegment) {
    const VectorSeries<n> along = VectorSeries<n>::Constant(element.b - element.a);
    const Series<n> denominator = Cross(ray.direction, along);
    if (denominator[0] == 0) return std::nullopt;
    return (-1.0 * Cross(q, along)) / denominator;
  }
  // The circle's equation about a: A t^2/2 + B t + C = 0 (see CrossArc).
  const double bend = 1 / element.radius;
  const VectorSeries<n> radial = VectorSeries<n>::Constant(element.radial_a);
  const Series<n> b = Dot(ray.direction, radial + bend * q);
  if (from_own_circle) return (-2 / bend) * b;
  const Series<n> c = Dot(q, radial) + (0.5 * bend) * Dot(q, q);
  const Series<n> discriminant = b * b - (2 * bend) * c;
  if (!(discriminant[0] > 0)) return std::nullopt;
  const Series<n> root = Sqrt(discriminant);
  if (b[0] < 0) {
    const Series<n> sum = root - b;
    return far ? (1 / bend) * sum : (2.0 * c) / sum;
  }
  const Series<n> sum = -1.0 * (root + b);
  return far ? (2.0 * c) / sum : (1 / bend) * sum;
}

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_CHAINS_RAY_SERIES_H_
