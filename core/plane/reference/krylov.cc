// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/krylov.h"

#include <cmath>
#include <cstddef>
#include <utility>

namespace flatlight {
namespace {

constexpr std::size_t kRestart = 40;
constexpr int kMostCycles = 8;

}  // namespace

ResidualMinimiser::ResidualMinimiser(std::vector<double> right, std::vector<double> start, double tolerance,
                                     std::vector<double> weights)
    : right_(std::move(right)),
      x_(std::move(start)),
      weights_(std::move(weights)),
      goal_(tolerance * std::sqrt(Product(right_, right_))) {}

double ResidualMinimiser::Product(const Vector& a, const Vector& b) const {
  double sum = 0;
  if (weights_.empty()) {
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  } else {
    for (std::size_t i = 0; i < a.size(); ++i) sum += weights_[i] * a[i] * b[i];
  }
  return sum;
}

bool ResidualMinimiser::Step(const LinearMap& map) {
  if (basis_.empty()) return !BeginCycle(map);
  const std::size_t j = columns_.size();
  Vector next(right_.size());
  map(basis_[j], next);
  Vector column(j + 2, 0.0);
  // Twice is enough to keep the basis orthogonal.
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t i = 0; i <= j; ++i) {
      const double share = Product(basis_[i], next);
      column[i] += share;
      for (std::size_t k = 0; k < next.size(); ++k) next[k] -= share * basis_[i][k];
    }
  }
  const double length = std::sqrt(Product(next, next));
  column[j + 1] = length;
  for (std::size_t i = 0; i < j; ++i) {
    const double rotated = cosine_[i] * column[i] + sine_[i] * column[i + 1];
    column[i + 1] = cosine_[i] * column[i + 1] - sine_[i] * column[i];
    column[i] = rotated;
  }
  const double radius = std::sqrt(column[j] * column[j] + length * length);
  if (radius > 0) {
    cosine_.push_back(column[j] / radius);
    sine_.push_back(length / radius);
    column[j] = radius;
    reduced_.push_back(-sine_[j] * reduced_[j]);
    reduced_[j] *= cosine_[j];
    columns_.push_back(std::move(column));
  }
  if (length > 0 && columns_.size() < kRestart && std::abs(reduced_.back()) > goal_) {
    for (double& v : next) v /= length;
    basis_.push_back(std::move(next));
    return false;
  }
  EndCycle();
  return false;
}

// Whether there is more to do.
bool ResidualMinimiser::BeginCycle(const LinearMap& map) {
  Vector residual(right_.size());
  map(x_, residual);
  for (std::size_t i = 0; i < right_.size(); ++i) residual[i] = right_[i] - residual[i];
  const double norm = std::sqrt(Product(residual, residual));
  if (!(norm > goal_) || cycles_ == kMostCycles || (cycles_ > 1 && !(norm < 0.5 * norm_before_))) return false;
  ++cycles_;
  norm_before_ = norm;
  for (double& v : residual) v /= norm;
  basis_.push_back(std::move(residual));
  reduced_.assign(1, norm);
  return true;
}

void ResidualMinimiser::EndCycle() {
  Vector shares(columns_.size());
  for (std::size_t j = columns_.size(); j-- > 0;) {
    double sum = reduced_[j];
    for (std::size_t k = j + 1; k < columns_.size(); ++k) sum -= columns_[k][j] * shares[k];
    shares[j] = sum / columns_[j][j];
    for (std::size_t k = 0; k < x_.size(); ++k) x_[k] += shares[j] * basis_[j][k];
  }
  basis_.clear();
  columns_.clear();
  cosine_.clear();
  sine_.clear();
}

}  // namespace flatlight
