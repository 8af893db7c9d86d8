// SPDX-License-Identifier: Apache-2.0
#include "core/math/trig.h"

#include <cmath>

#include "core/math/check.h"

namespace flatlight {
namespace {

// pi/2 = kPart1 + kPart2 + kPart3 + O(1e-37); the first two have 33 bits, so that n times them is exact for n < 2^20.
constexpr double kPart1 = 0x1.921fb544p+0;
constexpr double kPart2 = 0x1.0b4611a6p-34;
constexpr double kPart3 = 0x1.3198a2e037073p-69;
constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;

// Taylor series on |x| <= pi/4: the first terms left out are x^19/19! and x^18/18!, below 1e-19.
double SinPolynomial(double x) {
  const double z = x * x;
  constexpr double c3 = -1.0 / 6, c5 = 1.0 / 120, c7 = -1.0 / 5040, c9 = 1.0 / 362880, c11 = -1.0 / 39916800,
                   c13 = 1.0 / 6227020800, c15 = -1.0 / 1307674368000, c17 = 1.0 / 355687428096000;
  return x + x * z * (c3 + z * (c5 + z * (c7 + z * (c9 + z * (c11 + z * (c13 + z * (c15 + z * c17)))))));
}

double CosPolynomial(double x) {
  const double z = x * x;
  constexpr double c4 = 1.0 / 24, c6 = -1.0 / 720, c8 = 1.0 / 40320, c10 = -1.0 / 3628800, c12 = 1.0 / 479001600,
                   c14 = -1.0 / 87178291200, c16 = 1.0 / 20922789888000;
  return 1 - (0.5 * z - z * z * (c4 + z * (c6 + z * (c8 + z * (c10 + z * (c12 + z * (c14 + z * c16)))))));
}

}  // namespace

SinCosValue SinCos(double angle) {
  FLATLIGHT_DCHECK(angle >= -2e6 && angle <= 2e6);
  const double n = std::nearbyint(angle * kTwoOverPi);
  // angle - n pi/2 as high + low.
  const double first = angle - n * kPart1;
  const double second = n * kPart2;
  const double reduced = first - second;
  const double rest = ((first - reduced) - second) - n * kPart3;
  const double high = reduced + rest;
  const double low = (reduced - high) + rest;
  const double s0 = SinPolynomial(high);
  const double c0 = CosPolynomial(high);
  const double s = s0 + low * c0;
  const double c = c0 - low * s0;
  switch (static_cast<long long>(n) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

double AngleOf(double x, double y) {
  FLATLIGHT_DCHECK(y >= 0 && (x != 0 || y > 0));
  if (x < 0) return 2 * (kPart1 + (kPart2 + kPart3)) - AngleOf(-x, y);
  // Halved until small: tan(a/2) = y/(x + r).
  double tangent = y / (x + std::sqrt(x * x + y * y));
  constexpr int kHalvings = 3;
  for (int i = 1; i < kHalvings; ++i) tangent = tangent / (1 + std::sqrt(1 + tangent * tangent));
  // |tangent| < 0.2: the first term left out is tangent^25/25, below 2e-19 of the angle.
  const double z = tangent * tangent;
  double series = 0;
  for (int k = 23; k >= 3; k -= 2) series = -z * (1.0 / k + series);
  return (1 << kHalvings) * (tangent + tangent * series);
}

}  // namespace flatlight
