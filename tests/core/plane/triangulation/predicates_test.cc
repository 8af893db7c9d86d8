// SPDX-License-Identifier: Apache-2.0
// Signs against whole numbers of 128 bits.
#include "core/plane/triangulation/predicates.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

#include "core/math/vec.h"

namespace flatlight {
namespace {

__extension__ typedef __int128 Whole;

struct WholePoint {
  std::int64_t x;
  std::int64_t y;

  Point2 Scaled(double unit) const { return {static_cast<double>(x) * unit, static_cast<double>(y) * unit}; }
};

int SignOf(Whole value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

Whole Area(WholePoint a, WholePoint b, WholePoint c) {
  return Whole{a.x - c.x} * Whole{b.y - c.y} - Whole{a.y - c.y} * Whole{b.x - c.x};
}

Whole InCircle(WholePoint a, WholePoint b, WholePoint c, WholePoint d) {
  const auto square = [&](WholePoint p) {
    return Whole{p.x - d.x} * Whole{p.x - d.x} + Whole{p.y - d.y} * Whole{p.y - d.y};
  };
  const auto cross = [&](WholePoint p, WholePoint q) {
    return Whole{p.x - d.x} * Whole{q.y - d.y} - Whole{p.y - d.y} * Whole{q.x - d.x};
  };
  return square(a) * cross(b, c) + square(b) * cross(c, a) + square(c) * cross(a, b);
}

TEST(PredicatesTest, OrientationIsExactWhereRoundingWouldHideIt) {
  // A point that moves by single roundoffs beside a line on which two others lie: Kettner et al. 2008, "Classroom
  // examples of robustness problems in geometric computations".
  const WholePoint b{std::int64_t{12} << 53, std::int64_t{12} << 53}, c{std::int64_t{24} << 53, std::int64_t{24} << 53};
  int straight = 0;
  for (std::int64_t i = 0; i < 64; ++i) {
    for (std::int64_t j = 0; j < 64; ++j) {
      const WholePoint a{(std::int64_t{1} << 52) + i, (std::int64_t{1} << 52) + j};
      const int sign = Orientation(a.Scaled(0x1p-53), b.Scaled(0x1p-53), c.Scaled(0x1p-53));
      ASSERT_EQ(sign, SignOf(Area(a, b, c))) << i << " " << j;
      straight += sign == 0 ? 1 : 0;
    }
  }
  EXPECT_EQ(straight, 64);
}

TEST(PredicatesTest, OrientationOfPointsThatNearlyLieOnALine) {
  std::mt19937_64 random(1);
  const auto number = [&] { return static_cast<std::int64_t>(random() >> 12) - (std::int64_t{1} << 51); };
  int zeros = 0;
  for (int i = 0; i < 20000; ++i) {
    const WholePoint a{number(), number()};
    const std::int64_t dx = number() >> 30, dy = number() >> 30;
    const auto along = [&](std::int64_t times) { return WholePoint{a.x / 2 + times * dx, a.y / 2 + times * dy}; };
    WholePoint p = along(0), q = along(number() >> 32), r = along(number() >> 32);
    if (i % 3 != 0) r.x += static_cast<std::int64_t>(random() % 3) - 1;
    const double unit = i % 2 == 0 ? 0x1p-53 : 0x1p-400;
    const int sign = Orientation(p.Scaled(unit), q.Scaled(unit), r.Scaled(unit));
    ASSERT_EQ(sign, SignOf(Area(p, q, r)));
    ASSERT_EQ(sign, Orientation(q.Scaled(unit), r.Scaled(unit), p.Scaled(unit)));
    ASSERT_EQ(sign, -Orientation(q.Scaled(unit), p.Scaled(unit), r.Scaled(unit)));
    zeros += sign == 0 ? 1 : 0;
  }
  EXPECT_GT(zeros, 5000);
  EXPECT_LT(zeros, 15000);
}

TEST(PredicatesTest, WhatIsSaidToBeInsideACircleIs) {
  std::mt19937_64 random(2);
  int inside = 0, undecided = 0;
  for (int i = 0; i < 50000; ++i) {
    // Among few places many lie on a circle; or anywhere.
    const std::int64_t places = i % 2 == 0 ? 9 : std::int64_t{1} << 25;
    const auto number = [&] { return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(places)); };
    const WholePoint a{number(), number()}, b{number(), number()}, c{number(), number()}, d{number(), number()};
    if (Area(a, b, c) <= 0) continue;
    const bool said = IsInsideCircle(a.Scaled(0x1p-25), b.Scaled(0x1p-25), c.Scaled(0x1p-25), d.Scaled(0x1p-25));
    const bool is = InCircle(a, b, c, d) > 0;
    ASSERT_TRUE(is || !said);
    inside += is ? 1 : 0, undecided += is && !said ? 1 : 0;
  }
  EXPECT_GT(inside, 5000);
  EXPECT_EQ(undecided, 0) << "only what is within 1e-15 of the circle may be";
}

}  // namespace
}  // namespace flatlight
