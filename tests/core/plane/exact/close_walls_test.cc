// SPDX-License-Identifier: Apache-2.0
// Two walls hardly apart. Which of them is in front is beyond what coordinates tell where the gap is as small as their
// rounding: the light is then that of one order or of the other, or lies between.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/core/plane/exact/test_scenes.h"

namespace flatlight {
namespace {

// A floor from (-1, 0) to (1, 0) with one point, and two walls that shine above it, one over the other for a part of
// their length, the lower one the darker; turned, scaled and shifted as no double carries out exactly.
class CloseWalls {
 public:
  explicit CloseWalls(std::mt19937_64& random)
      : turn_(Uniform(random, -kPi, kPi)),
        scale_(std::exp(Uniform(random, -9, 9))),
        away_{Uniform(random, -2, 2), Uniform(random, -2, 2)},
        at_(Uniform(random, -0.9, 0.9)),
        height_(Uniform(random, 0.05, 2)),
        slope_(random() % 2 == 0 ? 0 : Uniform(random, -0.4, 0.4)),
        begin_(Uniform(random, -1, 0)),
        end_(begin_ + Uniform(random, 0.5, 1)),
        shift_(Uniform(random, -0.2, 0.2)),
        dark_(Uniform(random, 0.1, 1)),
        bright_(Uniform(random, 1.5, 3)) {}

  // The darker wall lower by `gap`, listed before the brighter one or after it, and drawn in either direction.
  SceneDescription At(double gap, bool dark_first, bool reversed) const {
    SceneDescription scene = EmptyScene();
    AddCurve(scene, SegmentDescription{World({-1, 0}), World({1, 0})});
    const auto add = [&](double shift, double lower, double radiance) {
      const Point2 a = World(Wall(begin_ + shift, lower)), b = World(Wall(end_ + shift, lower));
      AddCurve(scene, reversed ? SegmentDescription{b, a} : SegmentDescription{a, b}, radiance, true);
    };
    if (dark_first) add(shift_, gap, dark_);
    add(0, 0, bright_);
    if (!dark_first) add(shift_, gap, dark_);
    AddProbe(scene, 0, 1);
    // Half a step beside the point, which is in the middle.
    scene.probes[0].from = 0.5 * (at_ + 1) - 0.01, scene.probes[0].to = 0.5 * (at_ + 1) + 0.01;
    return scene;
  }

  // What is right if the darker wall is in front, and if the brighter one is.
  double DarkInFront(double gap) const {
    const Stretch dark = Dark(gap), bright = Bright();
    return dark_ * dark.Length() + bright_ * (bright.Length() - Both(dark, bright));
  }
  double BrightInFront(double gap) const {
    const Stretch dark = Dark(gap), bright = Bright();
    return bright_ * bright.Length() + dark_ * (dark.Length() - Both(dark, bright));
  }

 private:
  Point2 Wall(double x, double lower) const { return {x, height_ * (1 + slope_ * x) - lower}; }
  Point2 World(Point2 p) const {
    const Vector2 along{std::cos(turn_), std::sin(turn_)};
    return Point2{} + scale_ * (away_ + p.x * along + p.y * Left(along));
  }
  // Of sines of directions from the point.
  struct Stretch {
    double low, high;
    double Length() const { return high - low; }
  };
  Stretch Dark(double gap) const { return {Sine(Wall(begin_ + shift_, gap)), Sine(Wall(end_ + shift_, gap))}; }
  Stretch Bright() const { return {Sine(Wall(begin_, 0)), Sine(Wall(end_, 0))}; }
  double Sine(Point2 p) const { return (p.x - at_) / std::hypot(p.x - at_, p.y); }
  static double Both(const Stretch& a, const Stretch& b) { return std::min(a.high, b.high) - std::max(a.low, b.low); }

  double turn_, scale_;
  Vector2 away_;
  double at_, height_, slope_, begin_, end_, shift_, dark_, bright_;
};

// The closed form as it is found in the tree and, where there is one, in the triangulation.
template <typename Check>
void ForAll(double gap, const Check& check) {
  std::mt19937_64 random(20);
  for (int i = 0; i < 200; ++i) {
    const CloseWalls walls(random);
    for (const bool dark_first : {false, true}) {
      for (const bool reversed : {false, true}) {
        SCOPED_TRACE(testing::Message() << "gap " << gap << ", scene " << i << ' ' << dark_first << reversed);
        const auto scene = Build(walls.At(gap, dark_first, reversed));
        check(walls, Solve(*scene, 0, nullptr)[0]);
        if (const auto triangles = Triangulation::Of(*scene)) check(walls, Solve(*scene, 0, triangles.get())[0]);
      }
    }
  }
}

// What the scene's own numbers round away.
constexpr double kRounding = 1e-12;

TEST(CloseWallsTest, WhatIsInFrontIsSeenWhereCoordinatesTell) {
  for (const double gap : {1e-13, 1e-11, 1e-9, 1e-5}) {
    ForAll(gap, [&](const CloseWalls& walls, const WorldValue& value) {
      EXPECT_NEAR(value.irradiance, walls.DarkInFront(gap), value.irradiance_error + kRounding);
      EXPECT_LT(value.irradiance_error, kRounding);
      EXPECT_GT(walls.BrightInFront(gap), walls.DarkInFront(gap) + 1e-3);  // Or it would say nothing.
    });
  }
}

// No bound is promised, for either order may be found, in either of which all else is as it should be.
TEST(CloseWallsTest, WhereCoordinatesDoNotTellLightIsThatOfOneOrderOrBetween) {
  int dark = 0, bright = 0;
  for (const double gap : {0.0, 1e-17, 1e-16, 3e-16, 1e-15, 3e-15, 1e-14}) {
    ForAll(gap, [&](const CloseWalls& walls, const WorldValue& value) {
      const double low = walls.DarkInFront(gap), high = walls.BrightInFront(gap);
      EXPECT_GE(value.irradiance, low - kRounding);
      EXPECT_LE(value.irradiance, high + kRounding);
      for (const double number : {value.gradient, value.hessian}) EXPECT_TRUE(std::isfinite(number));
      for (const double bound : {value.irradiance_error, value.gradient_error, value.hessian_error})
        EXPECT_TRUE(bound >= 0 && std::isfinite(bound));
      (value.irradiance < 0.5 * (low + high) ? dark : bright) += 1;
    });
  }
  // Both do happen: this is the limit.
  EXPECT_GT(dark, 100);
  EXPECT_GT(bright, 100);
}

}  // namespace
}  // namespace flatlight
