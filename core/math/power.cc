// SPDX-License-Identifier: Apache-2.0
#include "core/math/power.h"

#include <cmath>
#include <numbers>

#include "core/math/check.h"

namespace flatlight {
namespace {

// ln 2 = kLn2High + kLn2Low; the first has 33 bits, so that n times it is exact for |n| < 2^20.
constexpr double kLn2High = 0x1.62e42feep-1;
constexpr double kLn2Low = 0x1.a39ef35793c76p-33;

double Exp(double y) {
  if (y < -746) return 0;
  const double n = std::nearbyint(y / std::numbers::ln2);
  const double r = (y - n * kLn2High) - n * kLn2Low;
  // Taylor on |r| < 0.35: the first term left out is r^15/15!, below 1e-19.
  double sum = 1;
  for (int k = 14; k >= 1; --k) sum = 1 + r / k * sum;
  return std::ldexp(sum, static_cast<int>(n));
}

}  // namespace

double Log(double x) {
  FLATLIGHT_DCHECK(x > 0);
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  if (mantissa < 0.5 * std::numbers::sqrt2) mantissa *= 2, --exponent;
  // log m = 2 artanh(f), f = (m - 1)/(m + 1), |f| < 0.172: the first term left out is f^27/27, below 1e-22.
  const double f = (mantissa - 1) / (mantissa + 1);
  const double z = f * f;
  double series = 0;
  for (int k = 25; k >= 3; k -= 2) series = z * (1.0 / k + series);
  return exponent * kLn2High + (exponent * kLn2Low + (2 * f + 2 * f * series));
}

double UnitPower(double base, double exponent) {
  FLATLIGHT_DCHECK(base >= 0 && base <= 1 && exponent >= 0);
  if (exponent == 0 || base == 1) return 1;
  if (base == 0) return 0;
  return Exp(exponent * Log(base));
}

}  // namespace flatlight
