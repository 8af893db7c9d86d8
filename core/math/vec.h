// SPDX-License-Identifier: Apache-2.0
// Points and vectors of the plane. A point is a place; a vector is a difference of places or a direction.
#ifndef FLATLIGHT_CORE_MATH_VEC_H_
#define FLATLIGHT_CORE_MATH_VEC_H_

#include <cmath>

namespace flatlight {

struct Vector2 {
  double x = 0;
  double y = 0;
  friend bool operator==(const Vector2&, const Vector2&) = default;
};

struct Point2 {
  double x = 0;
  double y = 0;
  friend bool operator==(const Point2&, const Point2&) = default;
};

constexpr Vector2 operator-(Point2 p, Point2 q) { return {p.x - q.x, p.y - q.y}; }
constexpr Point2 operator+(Point2 p, Vector2 v) { return {p.x + v.x, p.y + v.y}; }
constexpr Point2 operator-(Point2 p, Vector2 v) { return {p.x - v.x, p.y - v.y}; }
constexpr Vector2 operator+(Vector2 u, Vector2 v) { return {u.x + v.x, u.y + v.y}; }
constexpr Vector2 operator-(Vector2 u, Vector2 v) { return {u.x - v.x, u.y - v.y}; }
constexpr Vector2 operator-(Vector2 v) { return {-v.x, -v.y}; }
constexpr Vector2 operator*(double k, Vector2 v) { return {k * v.x, k * v.y}; }
constexpr Vector2 operator*(Vector2 v, double k) { return {k * v.x, k * v.y}; }
constexpr Vector2 operator/(Vector2 v, double k) { return {v.x / k, v.y / k}; }

constexpr double Dot(Vector2 u, Vector2 v) { return u.x * v.x + u.y * v.y; }
// Positive if v is counter-clockwise of u.
constexpr double Cross(Vector2 u, Vector2 v) { return u.x * v.y - u.y * v.x; }
// v turned by +90 degrees: the normal (front) of a curve whose tangent is v.
constexpr Vector2 Left(Vector2 v) { return {-v.y, v.x}; }
constexpr Vector2 Right(Vector2 v) { return {v.y, -v.x}; }
constexpr double LengthSquared(Vector2 v) { return Dot(v, v); }
inline double Length(Vector2 v) { return std::sqrt(LengthSquared(v)); }
// The same direction, its larger component +-1: of any length but 0.
inline Vector2 ScaledToUnit(Vector2 v) { return v / std::fmax(std::abs(v.x), std::abs(v.y)); }
// Requires a length whose square is neither 0 nor infinite.
inline Vector2 Normalized(Vector2 v) { return v / Length(v); }

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_MATH_VEC_H_
