// SPDX-License-Identifier: Apache-2.0
#include "client/cli/comparison/student.h"

#include <cmath>

namespace flatlight {
namespace {

// For an even number n of degrees of freedom P(|T| < t) = sin(theta) * sum over j < n/2 of c_j cos(theta)^2j with c_0 =
// 1, c_j = c_(j-1) (2j-1)/(2j), tan(theta) = t / sqrt(n).
constexpr int kTerms = kDegreesOfFreedom / 2;
constexpr double kFar = 2;  // From here on the tail itself is summed, to keep its digits.

}  // namespace

double StudentTail(double t) {
  const double cos2 = kDegreesOfFreedom / (kDegreesOfFreedom + t * t);
  const double sin = std::sqrt(1 - cos2);
  double term = 1, inside = 1;
  int j = 1;
  for (; j < kTerms; ++j) inside += term *= (2.0 * j - 1) / (2.0 * j) * cos2;
  if (t < kFar) return 1 - sin * inside;
  // The endless series adds up to 1 / sin(theta), so the tail is what the finite one leaves out.
  double outside = 0;
  do {
    outside += term *= (2.0 * j - 1) / (2.0 * j) * cos2;
    ++j;
  } while (term > 1e-17 * outside);
  return sin * outside;
}

double StudentQuantile(double probability) {
  double low = 0, high = 1;
  while (StudentTail(high) > probability) high *= 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (StudentTail(middle) > probability ? low : high) = middle;
  }
  return high;
}

}  // namespace flatlight
