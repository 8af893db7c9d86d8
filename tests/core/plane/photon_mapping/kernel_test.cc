// SPDX-License-Identifier: Apache-2.0
#include "core/plane/photon_mapping/kernel.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flatlight {
namespace {

constexpr Kernel kAll[] = {Kernel::kBox, Kernel::kTriangle, Kernel::kEpanechnikov, Kernel::kBiweight};

// By the midpoint rule; kernels have kinks at 0 and +-1, which are borders of its steps.
template <typename Function>
double Integral(double a, double b, Function f) {
  constexpr int kSteps = 20000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) sum += f(a + (i + 0.5) * (b - a) / kSteps);
  return sum * (b - a) / kSteps;
}

TEST(KernelTest, MomentsAreThoseOfTheValues) {
  for (const Kernel kernel : kAll) {
    const auto value = [&](double u) { return KernelValue(kernel, u); };
    EXPECT_NEAR(Integral(-1, 1, value), 1, 1e-8);
    EXPECT_NEAR(Integral(-1, 1, [&](double u) { return u * u * value(u); }), SecondMoment(kernel), 1e-8);
    EXPECT_NEAR(Integral(-1, 1, [&](double u) { return value(u) * value(u); }), Roughness(kernel), 1e-8);
    for (const auto& [a, b] : {std::pair(-0.3, 0.8), std::pair(0.0, 1.0), std::pair(-1.0, 0.25)}) {
      const auto moments = PartialMoments(kernel, a, b);
      for (std::size_t power = 0; power < moments.size(); ++power) {
        const auto weighed = [&](double u) { return std::pow(u, power) * value(u); };
        EXPECT_NEAR(Integral(a, 0, weighed) + Integral(0, b, weighed), moments[power], 1e-8) << power;
      }
    }
    EXPECT_EQ(KernelValue(kernel, 1.001), 0);
    EXPECT_EQ(KernelValue(kernel, -1.001), 0);
  }
}

// THEORY 18 B11.
TEST(KernelTest, KnownMoments) {
  EXPECT_NEAR(SecondMoment(Kernel::kBox), 1.0 / 3, 1e-15);
  EXPECT_NEAR(SecondMoment(Kernel::kTriangle), 1.0 / 6, 1e-15);
  EXPECT_NEAR(SecondMoment(Kernel::kEpanechnikov), 1.0 / 5, 1e-15);
  EXPECT_NEAR(SecondMoment(Kernel::kBiweight), 1.0 / 7, 1e-15);
}

// Constant and linear densities keep their value wherever the line ends.
TEST(KernelTest, EndedKernelsTellLinearDensities) {
  for (const Kernel kernel : kAll) {
    for (const auto& [a, b] : {std::pair(0.0, 3.0), std::pair(-0.2, 3.0), std::pair(-3.0, 0.0), std::pair(-0.1, 0.7),
                               std::pair(-2.0, 2.0), std::pair(0.0, 0.01)}) {
      const EndedKernel ended(kernel, a, b);
      const double low = std::max(a, -1.0), high = std::min(b, 1.0);
      const auto integral = [&](auto f) { return Integral(low, 0, f) + Integral(0, high, f); };
      EXPECT_NEAR(integral(ended), 1, 1e-6);
      EXPECT_NEAR(integral([&](double u) { return u * ended(u); }), 0, 1e-6);
      EXPECT_NEAR(integral([&](double u) { return u * u * ended(u); }), ended.second_moment, 1e-6);
    }
  }
}

}  // namespace
}  // namespace flatlight
