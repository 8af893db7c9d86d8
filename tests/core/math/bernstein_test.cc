// SPDX-License-Identifier: Apache-2.0
#include "core/math/bernstein.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace flatlight {
namespace {

template <typename F>
Bernstein Through(F f) {
  std::array<double, Bernstein::kCount> values{};
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = f(Bernstein::Nodes()[i]);
  return Bernstein::Through(values);
}

TEST(BernsteinTest, GoesThroughAPolynomialOfItsDegree) {
  const auto f = [](double t) { return 3 - t * (2 + t * (1 - 4 * std::pow(t, 6))); };
  const Bernstein b = Through(f);
  for (int i = 0; i <= 20; ++i) {
    const double t = i / 20.0;
    EXPECT_NEAR(b.At(t), f(t), 1e-12);
    EXPECT_GE(f(t), b.Min() - 1e-12);
    EXPECT_LE(f(t), b.Max() + 1e-12);
  }
}

TEST(BernsteinTest, FindsAllRoots) {
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> uniform(-0.5, 1.5);
  int most = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> roots(8);
    for (double& root : roots) root = uniform(engine);
    std::sort(roots.begin(), roots.end());
    bool apart = true;
    for (std::size_t i = 1; i < roots.size(); ++i) apart = apart && roots[i] - roots[i - 1] > 0.01;
    if (!apart) continue;
    const Bernstein b = Through([&](double t) {
      double product = 1;
      for (const double root : roots) product *= 4 * (t - root);
      return product;
    });
    const Bernstein::RootList found = b.Roots();
    std::size_t next = 0;
    for (const double root : roots) {
      if (root < 0 || root >= 1) continue;
      ASSERT_LT(next, found.count);
      EXPECT_NEAR(found.t[next++], root, 1e-6);
    }
    EXPECT_EQ(next, found.count);
    most = std::max(most, static_cast<int>(next));
  }
  EXPECT_GE(most, 6);
}

TEST(BernsteinTest, SeesPairsOfRootsThatAreClose) {
  for (const double apart : {1e-3, 1e-5}) {
    const Bernstein b = Through([&](double t) { return (t - 0.3) * (t - 0.3 - apart); });
    ASSERT_EQ(b.Roots().count, 2u);
    EXPECT_NEAR(b.Roots().t[1] - b.Roots().t[0], apart, 1e-3 * apart);
  }
  EXPECT_EQ(Through([](double t) { return (t - 0.3) * (t - 0.3) + 1e-9; }).Roots().count, 0u);
}

}  // namespace
}  // namespace flatlight
