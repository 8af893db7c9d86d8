// SPDX-License-Identifier: Apache-2.0
#include "core/plane/glossy/glossy_light.h"

#include <algorithm>
#include <cmath>

#include "core/math/check.h"
#include "core/plane/reference/panel_light.h"
#include "core/plane/reference/quadrature.h"

namespace flatlight {

GlossyLight::GlossyLight(const CellMesh& mesh, const std::vector<double>& points, const std::vector<double>& values)
    : mesh_(mesh), count_(points.size()), coefficients_(values.size(), 0.0) {
  FLATLIGHT_DCHECK(count_ <= kResidualCoefficients);
  const std::vector<double> matrix = CoefficientsFromValues(points);
  const std::size_t n = count_;
  std::vector<double> by_place;  // Coefficients of places, values of directions.
  std::size_t first = 0;
  for (const DirectionCell& cell : mesh.cells()) {
    const std::size_t d = cell.directions == 1 ? 1 : n;
    by_place.assign(n * d, 0.0);
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < d; ++j) by_place[k * d + j] += matrix[k * n + i] * values[first + i * d + j];
    double* const c = &coefficients_[first];
    for (std::size_t k = 0; k < n; ++k) {
      if (d == 1) {
        c[k] = by_place[k];
        continue;
      }
      for (std::size_t l = 0; l < d; ++l)
        for (std::size_t j = 0; j < d; ++j) c[k * d + l] += matrix[l * n + j] * by_place[k * d + j];
    }
    first_.push_back(first);
    first += n * d;
  }
}

double GlossyLight::At(std::size_t cell, double x, double y) const {
  const double* c = &coefficients_[first_[cell]];
  double p[kResidualCoefficients], q[kResidualCoefficients];
  Legendre(x, count_, p);
  double sum = 0;
  if (mesh_.cells()[cell].directions == 1) {
    for (std::size_t k = 0; k < count_; ++k) sum += c[k] * p[k];
    return sum;
  }
  Legendre(y, count_, q);
  for (std::size_t k = 0; k < count_; ++k, c += count_) {
    double of_directions = 0;
    for (std::size_t l = 0; l < count_; ++l) of_directions += c[l] * q[l];
    sum += p[k] * of_directions;
  }
  return sum;
}

double GlossyLight::Last(std::size_t cell) const {
  const double* const c = &coefficients_[first_[cell]];
  const std::size_t n = count_, d = mesh_.cells()[cell].directions == 1 ? 1 : n;
  double of_places = 0, of_directions = 0;
  for (std::size_t k = n - 2; k < n; ++k) {
    double place = 0, direction = 0;
    for (std::size_t l = 0; l < d; ++l) place += std::abs(c[k * d + l]);
    for (std::size_t i = 0; i < n && d > 1; ++i) direction += std::abs(c[i * d + k]);
    of_places = std::max(of_places, place), of_directions = std::max(of_directions, direction);
  }
  return of_places + of_directions;
}

}  // namespace flatlight
