// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/majorant.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace flatlight {
namespace {

constexpr std::size_t kSize = 40;

// Light in a closed room of unequal walls, and two that see all but nothing but each other.
LinearMap Room(double reflectance) {
  return [reflectance](const std::vector<double>& in, std::vector<double>& out) {
    out.assign(kSize, 0.0);
    double sum = 0, shares = 0;
    for (std::size_t j = 0; j + 2 < kSize; ++j) {
      const double share = 1 + static_cast<double>(j % 7);
      sum += share * in[j], shares += share;
    }
    constexpr double kSlit = 1e-6;
    for (std::size_t i = 0; i + 2 < kSize; ++i)
      out[i] = reflectance * ((1 - kSlit) * sum / shares + 0.5 * kSlit * (in[kSize - 2] + in[kSize - 1]));
    for (const std::size_t i : {kSize - 2, kSize - 1})
      out[i] = reflectance * (kSlit * sum / shares + (1 - kSlit) * in[2 * kSize - 3 - i]);
  };
}

std::vector<double> BoundsOf(const std::vector<double>& source, const LinearMap& map, double reflectance) {
  Majorant majorant(source, std::vector<double>(kSize, 1.0), reflectance);
  while (!majorant.Step(map)) continue;
  return majorant.bounds();
}

// By summing all bounces.
std::vector<double> Sum(const std::vector<double>& source, const LinearMap& map, double reflectance) {
  std::vector<double> sum = source, next;
  double left = 1;
  for (; left > 1e-4; left *= reflectance) {
    map(sum, next);
    for (std::size_t i = 0; i < kSize; ++i) sum[i] = source[i] + next[i];
  }
  return sum;
}

// Where nearly all is reflected, with a source that is far larger at one place than it is elsewhere: what a solver
// leaves over is small beside that place, and large beside all others.
TEST(MajorantTest, BoundsAreAboveAndNear) {
  for (const double reflectance : {0.5, 0.99, 0.9999}) {
    const LinearMap map = Room(reflectance);
    for (const double peak : {1.0, 1e3, 1e9}) {
      std::vector<double> source(kSize, 1e-3);
      source[3] = peak;
      const std::vector<double> bounds = BoundsOf(source, map, reflectance), sum = Sum(source, map, reflectance);
      std::vector<double> reflected;
      map(bounds, reflected);
      for (std::size_t i = 0; i < kSize; ++i) {
        EXPECT_GE(bounds[i] * (1 + 1e-12), source[i] + reflected[i]) << reflectance << ' ' << peak << ' ' << i;
        EXPECT_LE(bounds[i], 1.2 * sum[i] + 0.03 * *std::max_element(sum.begin(), sum.end()))
            << reflectance << ' ' << peak;
      }
    }
  }
}

// A solver that is given a map which its iterations cannot follow still ends, with a bound.
TEST(MajorantTest, BoundsHoldWhateverTheSolverLeaves) {
  // Each sees the next one: no step of the solver brings light to all.
  const LinearMap map = [](const std::vector<double>& in, std::vector<double>& out) {
    out.resize(in.size());
    for (std::size_t i = 0; i < in.size(); ++i) out[i] = 0.99 * in[(i + 1) % in.size()];
  };
  std::vector<double> source(500, 1e-6), reflected;
  source[250] = 1;
  Majorant majorant(source, std::vector<double>(500, 1.0), 0.99);
  while (!majorant.Step(map)) continue;
  map(majorant.bounds(), reflected);
  for (std::size_t i = 0; i < source.size(); ++i)
    EXPECT_GE(majorant.bounds()[i] * (1 + 1e-12), source[i] + reflected[i]) << i;
}

TEST(MajorantTest, WhereNoLightIsNoneIsAdded) {
  const LinearMap map = [](const std::vector<double>& in, std::vector<double>& out) {
    out = in;
    for (double& v : out) v *= 0.9;
  };
  Majorant majorant({0, 2}, {1, 1}, 0.9);
  while (!majorant.Step(map)) continue;
  EXPECT_EQ(majorant.bounds()[0], 0);
  EXPECT_GE(majorant.bounds()[1], 20);
}

}  // namespace
}  // namespace flatlight
