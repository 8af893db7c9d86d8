// SPDX-License-Identifier: Apache-2.0
#include "core/plane/glossy/power_table.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flatlight {
namespace {

TEST(PowerTableTest, IsThePower) {
  for (const double exponent : {0.1, 0.5, 1.0, 2.0, 7.3, 50.0, 1000.0, 1e5}) {
    const PowerTable table(exponent);
    EXPECT_LE(table.least(), 0.9999) << exponent;
    for (int i = 1; i <= 4000; ++i) {
      const double x = table.least() + (1 - table.least()) * i / 4000;
      const double truth = std::pow(x, exponent);
      EXPECT_NEAR(table.Power(x), truth, 4e-16 * (4 + exponent + std::abs(std::log(truth))) * truth)
          << exponent << " " << x;
    }
    EXPECT_EQ(table.Power(1), 1);
  }
}

TEST(PowerTableTest, WhatItLeavesOutIsNothing) {
  for (const double exponent : {1.0, 20.0, 1e5}) {
    const PowerTable table(exponent);
    EXPECT_LE(std::pow(table.least(), exponent), 1e-12) << exponent;
  }
}

}  // namespace
}  // namespace flatlight
