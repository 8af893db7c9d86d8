// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/krylov.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace flatlight {
namespace {

using Vector = std::vector<double>;

constexpr std::size_t kRestart = 40;
constexpr int kMostRestarts = 8;

double Product(const Vector& a, const Vector& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// One cycle. Returns the norm of the residual before it.
double Cycle(const LinearMap& map, const Vector& right, double goal, const std::function<bool()>& stop, Vector& x) {
  Vector residual(right.size());
  map(x, residual);
  for (std::size_t i = 0; i < right.size(); ++i) residual[i] = right[i] - residual[i];
  const double norm = std::sqrt(Product(residual, residual));
  if (!(norm > goal)) return norm;
  std::vector<Vector> basis(1, residual), columns;
  for (double& v : basis[0]) v /= norm;
  Vector cosine, sine, reduced(1, norm);
  while (columns.size() < kRestart && !stop() && std::abs(reduced.back()) > goal) {
    const std::size_t j = columns.size();
    Vector next(right.size());
    map(basis[j], next);
    Vector column;
    // Twice is enough to keep the basis orthogonal.
    column.assign(j + 2, 0.0);
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t i = 0; i <= j; ++i) {
        const double share = Product(basis[i], next);
        column[i] += share;
        for (std::size_t k = 0; k < next.size(); ++k) next[k] -= share * basis[i][k];
      }
    }
    const double length = std::sqrt(Product(next, next));
    column[j + 1] = length;
    for (std::size_t i = 0; i < j; ++i) {
      const double rotated = cosine[i] * column[i] + sine[i] * column[i + 1];
      column[i + 1] = cosine[i] * column[i + 1] - sine[i] * column[i];
      column[i] = rotated;
    }
    const double radius = std::sqrt(column[j] * column[j] + length * length);
    if (!(radius > 0)) break;
    cosine.push_back(column[j] / radius);
    sine.push_back(length / radius);
    column[j] = radius;
    reduced.push_back(-sine[j] * reduced[j]);
    reduced[j] *= cosine[j];
    columns.push_back(column);
    if (!(length > 0)) break;
    for (double& v : next) v /= length;
    basis.push_back(std::move(next));
  }
  Vector shares(columns.size());
  for (std::size_t j = columns.size(); j-- > 0;) {
    double sum = reduced[j];
    for (std::size_t k = j + 1; k < columns.size(); ++k) sum -= columns[k][j] * shares[k];
    shares[j] = sum / columns[j][j];
    for (std::size_t k = 0; k < x.size(); ++k) x[k] += shares[j] * basis[j][k];
  }
  return norm;
}

}  // namespace

void SolveByResiduals(const LinearMap& map, const Vector& right, double tolerance, const std::function<bool()>& stop,
                      Vector& x) {
  const double goal = tolerance * std::sqrt(Product(right, right));
  double before = 0;
  for (int restart = 0; restart < kMostRestarts; ++restart) {
    const double norm = Cycle(map, right, goal, stop, x);
    if (stop() || !(norm > goal) || (restart > 1 && !(norm < 0.5 * before))) return;
    before = norm;
  }
}

}  // namespace flatlight
