// SPDX-License-Identifier: Apache-2.0
// Truncated power series: a function and its derivatives, carried through arithmetic.
#ifndef FLATLIGHT_CORE_MATH_SERIES_H_
#define FLATLIGHT_CORE_MATH_SERIES_H_

#include <array>
#include <cmath>
#include <cstddef>

#include "core/math/trig.h"

namespace flatlight {

// f(x) = sum over k < n of c[k] x^k. The k-th derivative at 0 is k! c[k].
template <std::size_t n>
struct Series {
  std::array<double, n> c{};

  double operator[](std::size_t k) const { return c[k]; }
  double& operator[](std::size_t k) { return c[k]; }

  friend Series operator+(const Series& f, const Series& g) {
    Series sum;
    for (std::size_t k = 0; k < n; ++k) sum[k] = f[k] + g[k];
    return sum;
  }
  friend Series operator-(const Series& f, const Series& g) { return f + -1.0 * g; }
  friend Series operator*(double factor, const Series& f) {
    Series product;
    for (std::size_t k = 0; k < n; ++k) product[k] = factor * f[k];
    return product;
  }
  friend Series operator*(const Series& f, const Series& g) {
    Series product;
    for (std::size_t k = 0; k < n; ++k) product[k] = Times(f, g, k);
    return product;
  }
  // Requires g[0] != 0.
  friend Series operator/(const Series& f, const Series& g) {
    Series quotient;
    for (std::size_t k = 0; k < n; ++k) {
      double rest = f[k];
      for (std::size_t i = 0; i < k; ++i) rest -= quotient[i] * g[k - i];
      quotient[k] = rest / g[0];
    }
    return quotient;
  }
  // Requires f[0] > 0.
  friend Series Sqrt(const Series& f) {
    Series root;
    root[0] = std::sqrt(f[0]);
    for (std::size_t k = 1; k < n; ++k) {
      double rest = f[k];
      for (std::size_t i = 1; i < k; ++i) rest -= root[i] * root[k - i];
      root[k] = 0.5 * rest / root[0];
    }
    return root;
  }
  static Series Constant(double value) {
    Series f;
    f[0] = value;
    return f;
  }
  double Derivative(std::size_t k) const {
    double factorial = 1;
    for (std::size_t i = 2; i <= k; ++i) factorial *= static_cast<double>(i);
    return factorial * c[k];
  }
  // The k-th coefficient of a product, for series that are not known further yet.
  static double Times(const Series& f, const Series& g, std::size_t k) {
    double sum = 0;
    for (std::size_t i = 0; i <= k; ++i) sum += f[i] * g[k - i];
    return sum;
  }
};

// sin f and cos f.
template <std::size_t n>
struct SinCosSeries {
  Series<n> sin, cos;

  explicit SinCosSeries(const Series<n>& f) {
    const SinCosValue at = SinCos(f[0]);
    sin[0] = at.sin, cos[0] = at.cos;
    // sin' = cos f', cos' = -sin f'.
    for (std::size_t k = 1; k < n; ++k) {
      for (std::size_t i = 1; i <= k; ++i) {
        const double slope = static_cast<double>(i) * f[i] / static_cast<double>(k);
        sin[k] += slope * cos[k - i];
        cos[k] -= slope * sin[k - i];
      }
    }
  }
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_MATH_SERIES_H_
