// SPDX-License-Identifier: Apache-2.0
#include "core/math/power.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace flatlight {
namespace {

TEST(UnitPowerTest, AgreesWithLongDouble) {
  std::mt19937_64 random(1);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (int i = 0; i < 200000; ++i) {
    const double base = i % 3 == 0   ? 1 - std::exp(-35 * uniform())
                        : i % 3 == 1 ? uniform()
                                     : std::exp(-700 * uniform());
    const double exponent = std::exp(28 * uniform() - 14);
    const long double truth = std::pow(static_cast<long double>(base), static_cast<long double>(exponent));
    if (truth < 1e-300L) {
      ASSERT_LE(UnitPower(base, exponent), 1.1e-300) << base << " ^ " << exponent;
      continue;
    }
    const double bound = 4e-16 * (1 + std::abs(static_cast<double>(std::log(truth))));
    ASSERT_LE(std::abs(static_cast<double>(UnitPower(base, exponent) / truth - 1)), bound) << base << " ^ " << exponent;
  }
}

TEST(UnitPowerTest, EndsOfTheRange) {
  EXPECT_EQ(UnitPower(0, 3), 0);
  EXPECT_EQ(UnitPower(0, 0), 1);
  EXPECT_EQ(UnitPower(1, 1e300), 1);
  EXPECT_EQ(UnitPower(0.5, 1e300), 0);
  EXPECT_EQ(UnitPower(0.25, 2), 0.0625);
}

}  // namespace
}  // namespace flatlight
