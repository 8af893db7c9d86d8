// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_MATH_BEZIER_H_
#define FLATLIGHT_CORE_MATH_BEZIER_H_

#include <vector>

#include "core/math/vec.h"

namespace flatlight {

// Up to two numbers, in order.
struct Roots {
  int count = 0;
  double at[2] = {0, 0};
};
// Of a + b u + c u^2 strictly between 0 and 1, where it changes its sign.
Roots QuadraticRoots(double a, double b, double c);

// A cubic Bézier curve: P(u) for u in [0, 1], from p[0] to p[3].
struct Bezier {
  Point2 p[4];

  // At 0 and 1 the control points, bit for bit.
  Point2 At(double u) const;
  // dP/du and the next derivatives.
  Vector2 First(double u) const;
  Vector2 Second(double u) const;
  Vector2 Third() const;

  // Unit, toward increasing u; where the curve stands still (at a cusp, or at an end whose control points coincide)
  // that just beyond (side +1) or before (-1). Not for a curve that is a point.
  Vector2 Tangent(double u, int side) const;
  // d(tangent)/d(arc length) = Curvature * normal, and its derivative by arc length. Infinite where the curve stands
  // still.
  double Curvature(double u) const;
  double CurvatureChange(double u) const;
  double CurvatureChangeChange(double u) const;

  // Arc length between two parameters, from <= to, by Gauss's rule with 10 points: for stretches that turn little.
  double Length(double from, double to) const;
  // The parameter in [from, to] at an arc length from `from`.
  double AtLength(double length, double from, double to) const;

  // Where the curve changes the sense in which it turns.
  Roots Inflections() const;
  // Its ends, and where it turns back along an axis: they have the same box around them.
  std::vector<Point2> Extremes() const;
  // Largest extent of the control points along an axis.
  double Extent() const;
  // Whether all control points lie on a line, as well as doubles can say.
  bool IsStraight() const;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_MATH_BEZIER_H_
