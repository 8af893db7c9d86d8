// SPDX-License-Identifier: Apache-2.0
#include "core/plane/glossy/light_majorant.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace flatlight {
namespace {

using Values = LightMajorant::Values;

// Two places that see each other and themselves: w = g + T w in closed form.
TEST(LightMajorantTest, BoundsTheSolutionAndIsLittleMore) {
  for (const double share : {0.1, 0.49, 0.4999}) {
    const double a = share, b = 0.3 * share, g0 = 1, g1 = 1e-3;
    const auto map = [&](const Values& in, Values& out) {
      out[0] = a * in[0] + b * in[1];
      out[1] = 2 * b * in[0] + a * in[1];
    };
    LightMajorant majorant({g0, g1});
    int steps = 1;
    while (!majorant.Step(map)) ++steps;
    const double determinant = (1 - a) * (1 - a) - 2 * b * b;
    const double w0 = ((1 - a) * g0 + b * g1) / determinant, w1 = (2 * b * g0 + (1 - a) * g1) / determinant;
    EXPECT_GE(majorant.values()[0], w0);
    EXPECT_GE(majorant.values()[1], w1);
    EXPECT_LE(majorant.values()[0], 1.3 * w0);
    EXPECT_LE(majorant.values()[1], 1.3 * w1);
    EXPECT_LE(steps, 40);
  }
}

TEST(LightMajorantTest, WhatDoesNotFadeHasNoBound) {
  LightMajorant majorant({1});
  while (!majorant.Step([](const Values& in, Values& out) { out[0] = in[0]; })) continue;
  EXPECT_TRUE(std::isinf(majorant.values()[0]));
}

}  // namespace
}  // namespace flatlight
