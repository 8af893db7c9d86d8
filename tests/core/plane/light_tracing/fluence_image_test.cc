// SPDX-License-Identifier: Apache-2.0
#include "core/plane/light_tracing/fluence_image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace flatlight {
namespace {

// 7 x 5 pixels of 0.5 x 0.25.
PixelGrid Grid() { return {{-1, 2}, {2.5, 3.25}, 7, 5}; }
constexpr double kWidth = 0.5, kHeight = 0.25;

// The part of a line in a box, by halving it until what is left is short.
double LengthIn(Point2 from, Point2 to, Point2 low, Point2 high) {
  const auto inside = [&](Point2 p) { return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y; };
  if (inside(from) && inside(to)) return Length(to - from);
  if (std::max(from.x, to.x) < low.x || std::min(from.x, to.x) > high.x || std::max(from.y, to.y) < low.y ||
      std::min(from.y, to.y) > high.y || Length(to - from) < 1e-9) {
    return 0;
  }
  const Point2 middle = from + 0.5 * (to - from);
  return LengthIn(from, middle, low, high) + LengthIn(middle, to, low, high);
}

void ExpectLengths(Point2 from, Point2 to) {
  const PixelGrid grid = Grid();
  FluenceImage grey(grid, 1), colour(grid, 3);
  Spectrum flux;
  flux.value = {1, 2, 4};
  grey.AddLine(from, to, flux);
  colour.AddLine(from, to, flux);
  for (std::uint32_t y = 0; y < grid.height; ++y) {
    for (std::uint32_t x = 0; x < grid.width; ++x) {
      const Point2 low{grid.low.x + x * kWidth, grid.low.y + y * kHeight};
      const double length = LengthIn(from, to, low, {low.x + kWidth, low.y + kHeight});
      const double fluence = length / (kWidth * kHeight);
      const std::size_t pixel = y * grid.width + x;
      EXPECT_NEAR(grey.sums()[pixel], fluence, 1e-5) << from.x << ' ' << from.y << ' ' << to.x << ' ' << to.y;
      for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(colour.sums()[3 * pixel + c], grey.sums()[pixel] * flux.value[c]);
    }
  }
}

TEST(FluenceImageTest, EachPixelGetsTheLengthThroughIt) {
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> x(-2, 3.5), y(1.5, 3.75);
  for (int i = 0; i < 300; ++i) ExpectLengths({x(engine), y(engine)}, {x(engine), y(engine)});
}

TEST(FluenceImageTest, LinesAlongAnAxis) {
  for (const double a : {-3.0, -0.8, 0.3}) {
    for (const double b : {-0.7, 0.31, 4.0}) {
      ExpectLengths({a, 2.1}, {b, 2.1});
      ExpectLengths({b, 2.1}, {a, 2.1});
      ExpectLengths({0.1, a + 2.5}, {0.1, b + 2.5});
      ExpectLengths({0.1, b + 2.5}, {0.1, a + 2.5});
    }
  }
  ExpectLengths({-3, 1.9}, {3, 1.9});
  ExpectLengths({2.6, 0}, {2.6, 9});
}

// Which of two pixels a border belongs to is free; that it is counted once is not.
TEST(FluenceImageTest, LinesOnBordersAndThroughCornersCountOnce) {
  const auto sum_of = [](Point2 from, Point2 to) {
    FluenceImage image(Grid(), 1);
    image.AddLine(from, to, Spectrum::Grey(1));
    double sum = 0;
    for (const float value : image.sums()) sum += value;
    return sum * kWidth * kHeight;
  };
  EXPECT_NEAR(sum_of({0, 0}, {0, 9}), 1.25, 1e-6);
  EXPECT_NEAR(sum_of({0, 9}, {0, 0}), 1.25, 1e-6);
  EXPECT_NEAR(sum_of({-5, 2.5}, {9, 2.5}), 3.5, 1e-6);
  EXPECT_NEAR(sum_of({-1, 2}, {1.5, 3.25}), std::hypot(2.5, 1.25), 1e-6) << "a diagonal, from corner to corner";
  EXPECT_NEAR(sum_of({1.5, 3.25}, {-1, 2}), std::hypot(2.5, 1.25), 1e-6);
  EXPECT_NEAR(sum_of({-1e9, 2 - 5e8}, {1e9 + 1.5, 5e8 + 3.25}), std::hypot(2.5, 1.25), 1e-5) << "from far away";
  EXPECT_EQ(sum_of({0.3, 2.3}, {0.3, 2.3}), 0);
  EXPECT_EQ(sum_of({-2, 3}, {0, 5}), 0) << "past a corner";
}

}  // namespace
}  // namespace flatlight
