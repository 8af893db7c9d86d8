// SPDX-License-Identifier: Apache-2.0
#include "client/cli/statistics/distributions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "client/cli/statistics/moments.h"

namespace flatlight {
namespace {

// With 1 and 2 degrees of freedom the tail has closed forms.
TEST(Student, TailMatchesClosedForms) {
  for (const double t : {0.0, 0.1, 1.0, 7.0, 1e3}) {
    EXPECT_NEAR(StudentTail(t, 1), 1 - 2 / std::numbers::pi * std::atan(t), 1e-12);
    EXPECT_NEAR(StudentTail(t, 2), 1 - t / std::sqrt(2 + t * t), 1e-12);
  }
  EXPECT_NEAR(StudentTail(1e6, 2) / 1e-12, 1, 1e-9);  // 1 - 1/sqrt(1 + 2/t^2) = 1/t^2: the tail keeps its digits.
}

// Abramowitz & Stegun, table 26.10.
TEST(Student, TailMatchesTables) {
  EXPECT_NEAR(StudentTail(1.761310, 14), 0.1, 1e-6);
  EXPECT_NEAR(StudentTail(2.144787, 14), 0.05, 1e-6);
  EXPECT_NEAR(StudentTail(4.140454, 14), 0.001, 1e-8);
  EXPECT_NEAR(StudentQuantile(0.01, 5), 4.032143, 1e-6);
  EXPECT_NEAR(StudentQuantile(0.05, 1e9), 1.959964, 1e-6);
}

TEST(Student, QuantileIsTheInverse) {
  for (const double degrees : {1.0, 2.5, 14.0, 300.0})
    for (const double p : {1.0, 0.9, 0.3, 0.05, 1e-4, 1e-9, 1e-14})
      EXPECT_NEAR(StudentTail(StudentQuantile(p, degrees), degrees) / p, 1, 1e-9) << degrees << ' ' << p;
}

// With 2 degrees of freedom above, P(F > f) = (1 + 2 f / n)^(-n/2).
TEST(Fisher, TailMatchesClosedForm) {
  for (const double n : {2.0, 7.0, 224.0})
    for (const double f : {0.0, 0.3, 1.0, 5.0})
      EXPECT_NEAR(FisherTail(f, 2, n), std::pow(1 + 2 * f / n, -n / 2), 1e-12);
  EXPECT_NEAR(FisherTail(3.325835, 5, 10), 0.05, 1e-7);  // Abramowitz & Stegun, table 26.9, with more digits.
}

TEST(Moments, OfAFewValues) {
  const Moments moments = MomentsOf({2, 4, 4, 4, 5, 5, 7, 9});
  EXPECT_EQ(moments.count, 8);
  EXPECT_DOUBLE_EQ(moments.mean, 5);
  EXPECT_DOUBLE_EQ(moments.variance, 32.0 / 7);
  EXPECT_EQ(MomentsOf({3}).variance, 0);
  // A large offset costs no digits of the variance.
  EXPECT_NEAR(MomentsOf({1e9 + 1, 1e9 + 2, 1e9 + 3}).variance, 1, 1e-12);
}

TEST(Moments, Median) {
  EXPECT_EQ(Median({7}), 7);
  EXPECT_EQ(Median({9, 1, 5}), 5);
  EXPECT_EQ(Median({4, 1, 3, 2}), 2.5);
}

}  // namespace
}  // namespace flatlight
