// SPDX-License-Identifier: Apache-2.0
// After Shewchuk 1997, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates"
// (doi:10.1007/PL00009321): bounds of the filters, and sums without rounding as lists of components.
#include "core/plane/triangulation/predicates.h"

#include <cmath>
#include <initializer_list>

#include "core/math/tolerances.h"

namespace flatlight {
namespace {

struct Pair {
  double high;
  double low;
};

Pair TwoSum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

// The upper half of the digits (Dekker 1971).
double HighHalf(double a) {
  const double scaled = 0x1.0000002p27 * a;  // 2^27 + 1
  return scaled - (scaled - a);
}

Pair TwoProduct(double a, double b) {
  const double product = a * b;
  const double a_high = HighHalf(a), b_high = HighHalf(b);
  const double a_low = a - a_high, b_low = b - b_high;
  return {product, a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low)};
}

// A sum without rounding: components that do not overlap, the smallest first.
class ExactSum {
 public:
  void Add(double term) {
    int kept = 0;
    for (int i = 0; i < count_; ++i) {
      const Pair sum = TwoSum(term, component_[i]);
      term = sum.high;
      if (sum.low != 0) component_[kept++] = sum.low;
    }
    if (term != 0) component_[kept++] = term;
    count_ = kept;
  }

  void AddProduct(Pair a, Pair b, double sign) {
    for (const double x : {a.low, a.high}) {
      for (const double y : {b.low, b.high}) {
        const Pair product = TwoProduct(x, sign * y);
        Add(product.low), Add(product.high);
      }
    }
  }

  int Sign() const { return count_ == 0 ? 0 : component_[count_ - 1] > 0 ? 1 : -1; }

 private:
  double component_[16];
  int count_ = 0;
};

}  // namespace

int Orientation(Point2 a, Point2 b, Point2 c) {
  const double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
  const double area = left - right;
  const double bound = (3 + 16 * kUnitRoundoff) * kUnitRoundoff * (std::abs(left) + std::abs(right));
  if (std::abs(area) > bound) return area > 0 ? 1 : -1;
  ExactSum sum;
  sum.AddProduct(TwoSum(a.x, -c.x), TwoSum(b.y, -c.y), 1);
  sum.AddProduct(TwoSum(a.y, -c.y), TwoSum(b.x, -c.x), -1);
  return sum.Sign();
}

bool IsInsideCircle(Point2 a, Point2 b, Point2 c, Point2 d) {
  const Vector2 p = a - d, q = b - d, r = c - d;
  const double p2 = LengthSquared(p), q2 = LengthSquared(q), r2 = LengthSquared(r);
  const double determinant = p2 * Cross(q, r) + q2 * Cross(r, p) + r2 * Cross(p, q);
  const auto size = [](Vector2 u, Vector2 v) { return std::abs(u.x * v.y) + std::abs(u.y * v.x); };
  const double permanent = p2 * size(q, r) + q2 * size(r, p) + r2 * size(p, q);
  constexpr double kUnderflow = 1e-290;  // Far above what is lost where products become too small.
  return determinant > (10 + 96 * kUnitRoundoff) * kUnitRoundoff * permanent + kUnderflow;
}

}  // namespace flatlight
