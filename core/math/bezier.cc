// SPDX-License-Identifier: Apache-2.0
#include "core/math/bezier.h"

#include <algorithm>
#include <cmath>

#include "core/math/tolerances.h"

namespace flatlight {
namespace {

template <typename T>
T Mix(T a, T b, double u) {
  return {(1 - u) * a.x + u * b.x, (1 - u) * a.y + u * b.y};
}

}  // namespace

Roots QuadraticRoots(double a, double b, double c) {
  Roots roots;
  const double size = std::max({std::abs(a), std::abs(b), std::abs(c)});
  if (!(size > 0)) return roots;
  a /= size, b /= size, c /= size;
  const double discriminant = b * b - 4 * a * c;
  if (!(discriminant > 0)) return roots;
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  const auto keep = [&](double numerator, double denominator) {
    if (denominator == 0) return;
    const double root = numerator / denominator;
    if (root > 0 && root < 1) roots.at[roots.count++] = root;
  };
  keep(q, c), keep(a, q);
  if (roots.count == 2 && roots.at[0] > roots.at[1]) std::swap(roots.at[0], roots.at[1]);
  return roots;
}

Point2 Bezier::At(double u) const {
  const Point2 a = Mix(p[0], p[1], u), b = Mix(p[1], p[2], u), c = Mix(p[2], p[3], u);
  return Mix(Mix(a, b, u), Mix(b, c, u), u);
}

Vector2 Bezier::First(double u) const {
  const Vector2 a = p[1] - p[0], b = p[2] - p[1], c = p[3] - p[2];
  return 3 * Mix(Mix(a, b, u), Mix(b, c, u), u);
}

Vector2 Bezier::Second(double u) const {
  return 6 * Mix((p[2] - p[1]) - (p[1] - p[0]), (p[3] - p[2]) - (p[2] - p[1]), u);
}

Vector2 Bezier::Third() const { return 6 * ((p[3] - p[0]) - 3 * (p[2] - p[1])); }

Vector2 Bezier::Tangent(double u, int side) const {
  constexpr double kStill = 1e-12;
  const double size = Extent();
  const auto stands = [&](Vector2 v) { return std::max(std::abs(v.x), std::abs(v.y)) <= kStill * size; };
  Vector2 along = First(u);
  if (stands(along)) along = static_cast<double>(side) * Second(u);
  if (stands(along)) along = Third();
  const double largest = std::max(std::abs(along.x), std::abs(along.y));
  return Normalized(along / largest);
}

double Bezier::Curvature(double u) const {
  const Vector2 first = First(u);
  const double squared = LengthSquared(first);
  return Cross(first, Second(u)) / squared / std::sqrt(squared);
}

double Bezier::CurvatureChange(double u) const {
  const Vector2 first = First(u), second = Second(u);
  const double squared = LengthSquared(first);
  return (Cross(first, Third()) - 3 * (Cross(first, second) / squared) * Dot(first, second)) / squared / squared;
}

double Bezier::CurvatureChangeChange(double u) const {
  const Vector2 first = First(u), second = Second(u), third = Third();
  const double squared = LengthSquared(first), turn = Cross(first, second), turn_first = Cross(first, third);
  const double stretch = Dot(first, second) / squared;
  const double stretch_first = (LengthSquared(second) + Dot(first, third)) / squared;
  return (Cross(second, third) - 7 * turn_first * stretch - 3 * turn * stretch_first + 18 * turn * stretch * stretch) /
         squared / squared / std::sqrt(squared);
}

double Bezier::Length(double from, double to) const {
  constexpr double kNodes[] = {0.1488743389816312, 0.4333953941292472, 0.6794095682990244, 0.8650633666889845,
                               0.9739065285171717};
  constexpr double kWeights[] = {0.2955242247147529, 0.2692667193099963, 0.2190863625159821, 0.1494513491505806,
                                 0.0666713443086881};
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = 0;
  for (int i = 4; i >= 0; --i) {
    const double step = half * kNodes[i];
    sum += kWeights[i] * (::flatlight::Length(First(middle - step)) + ::flatlight::Length(First(middle + step)));
  }
  return half * sum;
}

double Bezier::AtLength(double length, double from, double to) const {
  double low = from, high = to;
  double u = from + (to - from) * std::clamp(length / Length(from, to), 0.0, 1.0);
  for (int i = 0; i < 60 && low < high; ++i) {
    const double excess = Length(from, u) - length;
    (excess > 0 ? high : low) = u;
    double next = u - excess / ::flatlight::Length(First(u));
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    if (std::abs(next - u) <= 2 * kUnitRoundoff) return next;
    u = next;
  }
  return u;
}

Roots Bezier::Inflections() const {
  // cross(P', P'') of P = c0 + c1 u + c2 u^2 + c3 u^3.
  const Vector2 c1 = 3 * (p[1] - p[0]);
  const Vector2 c2 = 3 * ((p[2] - p[1]) - (p[1] - p[0]));
  const Vector2 c3 = (p[3] - p[0]) - 3 * (p[2] - p[1]);
  return QuadraticRoots(2 * Cross(c1, c2), 6 * Cross(c1, c3), 6 * Cross(c2, c3));
}

std::vector<Point2> Bezier::Extremes() const {
  std::vector<Point2> points{p[0], p[3]};
  const Vector2 a = p[1] - p[0], b = p[2] - p[1], c = p[3] - p[2];
  const auto add_turns = [&](double d0, double d1, double d2) {
    const Roots turns = QuadraticRoots(d0, 2 * (d1 - d0), d0 - 2 * d1 + d2);
    for (int i = 0; i < turns.count; ++i) points.push_back(At(turns.at[i]));
  };
  add_turns(a.x, b.x, c.x), add_turns(a.y, b.y, c.y);
  return points;
}

double Bezier::Extent() const {
  const auto [low_x, high_x] = std::minmax({p[0].x, p[1].x, p[2].x, p[3].x});
  const auto [low_y, high_y] = std::minmax({p[0].y, p[1].y, p[2].y, p[3].y});
  return std::max(high_x - low_x, high_y - low_y);
}

bool Bezier::IsStraight() const {
  // About the two points that are farthest apart.
  Vector2 longest;
  for (const Point2& a : p)
    for (const Point2& b : p)
      if (LengthSquared(b - a) > LengthSquared(longest)) longest = b - a;
  double largest = 0;
  for (const Point2& point : p) largest = std::max({largest, std::abs(point.x), std::abs(point.y)});
  const double length = ::flatlight::Length(longest);
  for (const Point2& point : p)
    if (std::abs(Cross(longest, point - p[0])) > 8 * kUnitRoundoff * largest * length) return false;
  return true;
}

}  // namespace flatlight
