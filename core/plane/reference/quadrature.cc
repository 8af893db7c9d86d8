// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/quadrature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/math/check.h"
#include "core/math/trig.h"

namespace flatlight {
namespace {

struct Polynomial {
  double value;
  double slope;
};

// P_n and its derivative inside (-1, 1).
Polynomial LegendreAt(std::size_t n, double x) {
  double before = 1, p = x;
  for (std::size_t k = 1; k < n; ++k) {
    const auto m = static_cast<double>(k);
    const double next = ((2 * m + 1) * x * p - m * before) / (m + 1);
    before = p, p = next;
  }
  return {p, static_cast<double>(n) * (x * p - before) / (x * x - 1)};
}

GaussRule MakeGauss(std::size_t points) {
  GaussRule rule;
  rule.node.resize(points);
  rule.weight.resize(points);
  const auto n = static_cast<double>(points);
  for (std::size_t i = 0; i < points; ++i) {
    // Newton's method from Tricomi's guess.
    double x = -SinCos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (n + 0.5)).cos;
    for (int step = 0; step < 8; ++step) {
      const Polynomial p = LegendreAt(points, x);
      x -= p.value / p.slope;
    }
    const double slope = LegendreAt(points, x).slope;
    rule.node[i] = x;
    rule.weight[i] = 2 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

}  // namespace

const GaussRule& Gauss(std::size_t points) {
  static const auto& rules = *new std::vector<GaussRule>([] {
    std::vector<GaussRule> made(1);
    for (std::size_t n = 1; n <= kMostGaussPoints; ++n) made.push_back(MakeGauss(n));
    return made;
  }());
  FLATLIGHT_DCHECK(points >= 1 && points <= kMostGaussPoints);
  return rules[points];
}

void Legendre(double x, std::size_t count, double* p) {
  p[0] = 1;
  if (count > 1) p[1] = x;
  // (k + 1) P_{k+1} = (2 k + 1) x P_k - k P_{k-1}, with the quotients at hand.
  static const auto& quotients = *new std::array<double, 2 * kMostGaussPoints>([] {
    std::array<double, 2 * kMostGaussPoints> made{};
    for (std::size_t k = 1; k < made.size(); ++k) made[k] = static_cast<double>(k) / static_cast<double>(k + 1);
    return made;
  }());
  for (std::size_t k = 1; k + 1 < count; ++k) {
    const double q = quotients[k];
    p[k + 1] = (1 + q) * x * p[k] - q * p[k - 1];
  }
}

const double* LegendreAtGauss(std::size_t points) {
  static const auto& tables = *new std::vector<std::vector<double>>([] {
    std::vector<std::vector<double>> made(1);
    for (std::size_t n = 1; n <= kMostGaussPoints; ++n) {
      std::vector<double> table(n * kTabulated, 0.0);
      for (std::size_t i = 0; i < n; ++i) Legendre(Gauss(n).node[i], std::min(n, kTabulated), &table[i * kTabulated]);
      made.push_back(std::move(table));
    }
    return made;
  }());
  return tables[points].data();
}

void LegendreWithSlopes(double x, std::size_t count, double* p, double* slope) {
  Legendre(x, count, p);
  slope[0] = 0;
  if (count > 1) slope[1] = 1;
  for (std::size_t k = 1; k + 1 < count; ++k) slope[k + 1] = slope[k - 1] + static_cast<double>(2 * k + 1) * p[k];
}

void LegendreWithBends(double x, std::size_t count, double* p, double* slope, double* bend) {
  LegendreWithSlopes(x, count, p, slope);
  bend[0] = 0;
  if (count > 1) bend[1] = 0;
  for (std::size_t k = 1; k + 1 < count; ++k) bend[k + 1] = bend[k - 1] + static_cast<double>(2 * k + 1) * slope[k];
}

std::vector<double> PointsBetween(const GaussRule& rule) {
  const std::size_t n = rule.node.size();
  std::vector<double> points;
  points.push_back(0.5 * (rule.node.front() - 1));
  for (std::size_t i = 0; i + 1 < n; ++i) {
    // The slope vanishes once between two nodes.
    double low = rule.node[i], high = rule.node[i + 1];
    const double sign = LegendreAt(n, low).slope > 0 ? 1 : -1;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (low + high);
      (sign * LegendreAt(n, middle).slope > 0 ? low : high) = middle;
    }
    points.push_back(0.5 * (low + high));
  }
  points.push_back(0.5 * (rule.node.back() + 1));
  return points;
}

std::vector<double> NodesAndBetween(const GaussRule& rule) {
  const std::vector<double> between = PointsBetween(rule);
  std::vector<double> points;
  for (std::size_t i = 0; i < rule.node.size(); ++i) points.push_back(between[i]), points.push_back(rule.node[i]);
  points.push_back(between.back());
  return points;
}

std::vector<double> CoefficientsFromValues(const std::vector<double>& points) {
  const std::size_t n = points.size();
  // Gauss-Jordan elimination with row pivots.
  std::vector<double> a(n * n), inverse(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    Legendre(points[i], n, &a[i * n]);
    inverse[i * n + i] = 1;
  }
  for (std::size_t column = 0; column < n; ++column) {
    std::size_t pivot = column;
    for (std::size_t i = column + 1; i < n; ++i)
      if (std::abs(a[i * n + column]) > std::abs(a[pivot * n + column])) pivot = i;
    for (std::size_t k = 0; k < n; ++k) {
      std::swap(a[pivot * n + k], a[column * n + k]);
      std::swap(inverse[pivot * n + k], inverse[column * n + k]);
    }
    const double scale = 1 / a[column * n + column];
    for (std::size_t k = 0; k < n; ++k) a[column * n + k] *= scale, inverse[column * n + k] *= scale;
    for (std::size_t i = 0; i < n; ++i) {
      const double factor = a[i * n + column];
      if (i == column || factor == 0) continue;
      for (std::size_t k = 0; k < n; ++k) {
        a[i * n + k] -= factor * a[column * n + k];
        inverse[i * n + k] -= factor * inverse[column * n + k];
      }
    }
  }
  return inverse;
}

}  // namespace flatlight
