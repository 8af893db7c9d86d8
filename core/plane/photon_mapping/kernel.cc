// SPDX-License-Identifier: Apache-2.0
#include "core/plane/photon_mapping/kernel.h"

#include <algorithm>
#include <cmath>

namespace flatlight {
namespace {

// A kernel for u >= 0 as a polynomial.
std::array<double, 5> Coefficients(Kernel kernel) {
  switch (kernel) {
    case Kernel::kBox:
      return {0.5, 0, 0, 0, 0};
    case Kernel::kTriangle:
      return {1, -1, 0, 0, 0};
    case Kernel::kEpanechnikov:
      return {0.75, 0, -0.75, 0, 0};
    case Kernel::kBiweight:
      break;
  }
  return {0.9375, 0, -1.875, 0, 0.9375};
}

// The integral of u^power K from 0 to u >= 0.
double FromZero(const std::array<double, 5>& coefficients, std::size_t power, double u) {
  double sum = 0, u_to_n = u;
  for (std::size_t i = 0; i < power; ++i) u_to_n *= u;
  auto n = static_cast<double>(power + 1);
  for (const double c : coefficients) {
    sum += c * u_to_n / n;
    u_to_n *= u;
    ++n;
  }
  return sum;
}

}  // namespace

double KernelValue(Kernel kernel, double u) {
  const double w = 1 - u * u;
  if (w < 0) return 0;
  switch (kernel) {
    case Kernel::kBox:
      return 0.5;
    case Kernel::kTriangle:
      return 1 - std::abs(u);
    case Kernel::kEpanechnikov:
      return 0.75 * w;
    case Kernel::kBiweight:
      break;
  }
  return 0.9375 * w * w;
}

double SecondMoment(Kernel kernel) { return 2 * FromZero(Coefficients(kernel), 2, 1); }

double Roughness(Kernel kernel) {
  switch (kernel) {
    case Kernel::kBox:
      return 0.5;
    case Kernel::kTriangle:
      return 2.0 / 3;
    case Kernel::kEpanechnikov:
      return 0.6;
    case Kernel::kBiweight:
      break;
  }
  return 5.0 / 7;
}

std::array<double, 4> PartialMoments(Kernel kernel, double a, double b) {
  const std::array<double, 5> coefficients = Coefficients(kernel);
  a = std::clamp(a, -1.0, 1.0);
  b = std::clamp(b, -1.0, 1.0);
  std::array<double, 4> moments;
  for (std::size_t power = 0; power < moments.size(); ++power) {
    const double mirrored = power % 2 == 0 ? -1 : 1;
    const auto from_zero = [&](double u) {
      return u < 0 ? mirrored * FromZero(coefficients, power, -u) : FromZero(coefficients, power, u);
    };
    moments[power] = from_zero(b) - from_zero(a);
  }
  return moments;
}

EndedKernel::EndedKernel(Kernel of, double a, double b) : kernel(of) {
  const auto [m0, m1, m2, m3] = PartialMoments(kernel, a, b);
  if (a <= -1 && b >= 1) {
    second_moment = m2;
    return;
  }
  const double determinant = m0 * m2 - m1 * m1;
  constant = m2 / determinant;
  slope = -m1 / determinant;
  second_moment = constant * m2 + slope * m3;
}

}  // namespace flatlight
