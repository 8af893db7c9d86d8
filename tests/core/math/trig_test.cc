// SPDX-License-Identifier: Apache-2.0
#include "core/math/trig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace flatlight {
namespace {

// Against long double, whose 64 bits leave at least 2^-11 units in the last place of a double.
TEST(SinCosTest, IsWithinTwoUnitsInTheLastPlace) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 200000; ++i) {
    const double range = i % 2 == 0 ? 7 : 1.9e6;
    const double angle = (static_cast<double>(random() >> 11) * 0x1p-52 - 1) * range;
    const SinCosValue value = SinCos(angle);
    const long double s = std::sin(static_cast<long double>(angle)), c = std::cos(static_cast<long double>(angle));
    ASSERT_LE(std::abs(static_cast<double>(value.sin - s)), 2 * 0x1p-53 * std::abs(static_cast<double>(s)) + 1e-25)
        << angle;
    ASSERT_LE(std::abs(static_cast<double>(value.cos - c)), 2 * 0x1p-53 * std::abs(static_cast<double>(c)) + 1e-25)
        << angle;
  }
}

TEST(SinCosTest, QuartersOfATurn) {
  EXPECT_EQ(SinCos(0).sin, 0);
  EXPECT_EQ(SinCos(0).cos, 1);
  EXPECT_EQ(SinCos(0x1.921fb54442d18p+0).sin, 1);
  EXPECT_NEAR(SinCos(0x1.921fb54442d18p+0).cos, 6.123233995736766e-17, 1e-31);
  EXPECT_NEAR(SinCos(-0x1.921fb54442d18p+1).sin, -1.2246467991473532e-16, 1e-31);
}

TEST(AngleOfTest, IsTheArcTangent) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 200000; ++i) {
    const double x = static_cast<double>(random() >> 11) * 0x1p-52 - 1;
    const double y = std::exp2(-40.0 * static_cast<double>(i % 7) / 6) * static_cast<double>(random() >> 11) * 0x1p-53;
    const long double truth = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
    ASSERT_LE(std::abs(static_cast<double>(AngleOf(x, y) - truth)), 8e-16 * static_cast<double>(truth))
        << x << ' ' << y;
  }
  EXPECT_EQ(AngleOf(1, 0), 0);
  EXPECT_DOUBLE_EQ(AngleOf(-1, 0), 0x1.921fb54442d18p+1);
  EXPECT_DOUBLE_EQ(AngleOf(0, 2), 0x1.921fb54442d18p+0);
}

}  // namespace
}  // namespace flatlight
