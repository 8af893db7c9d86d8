// SPDX-License-Identifier: Apache-2.0
#include "core/math/bernstein.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/math/trig.h"

namespace flatlight {
namespace {

constexpr std::size_t kCount = Bernstein::kCount;
// Halvings of [0, 1] in search of a root: what is left is shorter than 1e-12.
constexpr int kMostHalvings = 40;
// Of a root between 0 and 1.
constexpr double kRootTolerance = 1e-11;

using Matrix = std::array<std::array<double, kCount>, kCount>;

std::array<double, kCount> MakeNodes() {
  std::array<double, kCount> nodes{};
  for (std::size_t i = 0; i < kCount; ++i)
    nodes[i] = 0.5 * (1 - SinCos(std::numbers::pi * (static_cast<double>(i) + 0.5) / kCount).cos);
  return nodes;
}

// From values at the nodes to coefficients: the inverse of the basis at the nodes, by Gauss and Jordan.
Matrix MakeInverse() {
  Matrix left{}, right{};
  for (std::size_t i = 0; i < kCount; ++i) {
    const double t = Bernstein::Nodes()[i];
    double binomial = 1;
    for (std::size_t k = 0; k < kCount; ++k) {
      double basis = binomial;
      for (std::size_t n = 0; n < k; ++n) basis *= t;
      for (std::size_t n = k + 1; n < kCount; ++n) basis *= 1 - t;
      left[i][k] = basis;
      binomial = binomial * static_cast<double>(kCount - 1 - k) / static_cast<double>(k + 1);
    }
    right[i][i] = 1;
  }
  for (std::size_t column = 0; column < kCount; ++column) {
    std::size_t pivot = column;
    for (std::size_t i = column; i < kCount; ++i)
      if (std::abs(left[i][column]) > std::abs(left[pivot][column])) pivot = i;
    std::swap(left[column], left[pivot]);
    std::swap(right[column], right[pivot]);
    const double scale = 1 / left[column][column];
    for (std::size_t k = 0; k < kCount; ++k) left[column][k] *= scale, right[column][k] *= scale;
    for (std::size_t i = 0; i < kCount; ++i) {
      if (i == column) continue;
      const double factor = left[i][column];
      for (std::size_t k = 0; k < kCount; ++k) {
        left[i][k] -= factor * left[column][k];
        right[i][k] -= factor * right[column][k];
      }
    }
  }
  return right;
}

// The parts of a polynomial before and after the middle, each on [0, 1] (de Casteljau).
std::pair<Bernstein, Bernstein> Halves(const Bernstein& f) {
  std::pair<Bernstein, Bernstein> halves;
  std::array<double, kCount> row = f.b;
  for (std::size_t n = 0; n < kCount; ++n) {
    halves.first.b[n] = row[0];
    halves.second.b[kCount - 1 - n] = row[kCount - 1 - n];
    for (std::size_t k = 0; k + 1 + n < kCount; ++k) row[k] = 0.5 * (row[k] + row[k + 1]);
  }
  return halves;
}

int SignChanges(const Bernstein& f) {
  int changes = 0;
  for (std::size_t k = 1; k < kCount; ++k) changes += (f.b[k - 1] < 0) != (f.b[k] < 0) ? 1 : 0;
  return changes;
}

// The one root between `low` and `high`, where the polynomial has different signs: false position, kept from getting
// stuck by halving the weight of the end that stays (Dowell and Jarratt 1971, "Illinois").
double OneRoot(const Bernstein& f) {
  double low = 0, high = 1, at_low = f.b.front(), at_high = f.b.back(), last = -1;
  int side = 0;
  for (int step = 0; step < 60 && high - low > kRootTolerance; ++step) {
    double t = (low * at_high - high * at_low) / (at_high - at_low);
    if (!(t > low && t < high)) t = 0.5 * (low + high);
    const double at_t = f.At(t);
    if (std::abs(t - last) < kRootTolerance || at_t == 0) return t;
    last = t;
    if ((at_t < 0) == (at_low < 0)) {
      low = t, at_low = at_t;
      if (side == -1) at_high *= 0.5;
      side = -1;
    } else {
      high = t, at_high = at_t;
      if (side == 1) at_low *= 0.5;
      side = 1;
    }
  }
  return 0.5 * (low + high);
}

void FindRoots(const Bernstein& f, double begin, double length, int halvings, Bernstein::RootList& roots) {
  const int changes = SignChanges(f);
  if (changes == 0) return;
  if (changes == 1) {
    if (roots.count < kCount) roots.t[roots.count++] = begin + length * OneRoot(f);
    return;
  }
  if (halvings == kMostHalvings) return;
  const auto [before, after] = Halves(f);
  FindRoots(before, begin, 0.5 * length, halvings + 1, roots);
  FindRoots(after, begin + 0.5 * length, 0.5 * length, halvings + 1, roots);
}

}  // namespace

const std::array<double, kCount>& Bernstein::Nodes() {
  static const std::array<double, kCount> kNodes = MakeNodes();
  return kNodes;
}

Bernstein Bernstein::Through(const std::array<double, kCount>& values) {
  static const Matrix kInverse = MakeInverse();
  Bernstein f;
  for (std::size_t k = 0; k < kCount; ++k)
    for (std::size_t i = 0; i < kCount; ++i) f.b[k] += kInverse[k][i] * values[i];
  return f;
}

double Bernstein::At(double t) const {
  // Horner's scheme in t/(1 - t), or in its inverse, with the binomials on the way.
  const double s = 1 - t;
  double sum, binomial = 1, power = 1;
  if (t <= 0.5) {
    const double ratio = t / s;
    sum = b[0];
    for (std::size_t k = 1; k < kCount; ++k) {
      binomial = binomial * static_cast<double>(kCount - k) / static_cast<double>(k);
      power *= ratio;
      sum += binomial * power * b[k];
    }
    for (std::size_t k = 1; k < kCount; ++k) sum *= s;
    return sum;
  }
  const double ratio = s / t;
  sum = b[kCount - 1];
  for (std::size_t k = 1; k < kCount; ++k) {
    binomial = binomial * static_cast<double>(kCount - k) / static_cast<double>(k);
    power *= ratio;
    sum += binomial * power * b[kCount - 1 - k];
  }
  for (std::size_t k = 1; k < kCount; ++k) sum *= t;
  return sum;
}

double Bernstein::Min() const { return *std::min_element(b.begin(), b.end()); }
double Bernstein::Max() const { return *std::max_element(b.begin(), b.end()); }

Bernstein::RootList Bernstein::Roots() const {
  RootList roots;
  FindRoots(*this, 0, 1, 0, roots);
  return roots;
}

}  // namespace flatlight
