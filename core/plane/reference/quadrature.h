// SPDX-License-Identifier: Apache-2.0
// Gauss-Legendre rules and Legendre polynomials on [-1, 1].
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_QUADRATURE_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_QUADRATURE_H_

#include <cstddef>
#include <vector>

namespace flatlight {

struct GaussRule {
  std::vector<double> node;  // Increasing.
  std::vector<double> weight;
};

// Of `points` >= 1 points, exact for polynomials of degree 2 points - 1. Made once.
inline constexpr std::size_t kMostGaussPoints = 32;
const GaussRule& Gauss(std::size_t points);

// p[k] = P_k(x) for k < count, count >= 1.
void Legendre(double x, std::size_t count, double* p);
// The derivatives as well.
void LegendreWithSlopes(double x, std::size_t count, double* p, double* slope);
// And the second derivatives.
void LegendreWithBends(double x, std::size_t count, double* p, double* slope, double* bend);

// The first kTabulated polynomials at each of the nodes of the rule, node after node; 0 from the `points`-th on. Made
// once.
inline constexpr std::size_t kTabulated = 18;
const double* LegendreAtGauss(std::size_t points);

// The points between the nodes of a Gauss rule where its polynomial is largest, and one beyond each outer node: one
// more than the rule has.
std::vector<double> PointsBetween(const GaussRule& rule);
// Both, in increasing order.
std::vector<double> NodesAndBetween(const GaussRule& rule);

// The matrix, row after row, that makes Legendre coefficients of the values at distinct points.
std::vector<double> CoefficientsFromValues(const std::vector<double>& points);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_QUADRATURE_H_
