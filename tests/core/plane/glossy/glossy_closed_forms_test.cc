// SPDX-License-Identifier: Apache-2.0
// Light that one phong lobe reflects, against quadrature that knows the formulas of the lobe and of the scene alone.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>

#include "tests/core/plane/glossy/glossy_rooms.h"

namespace flatlight {
namespace {

constexpr double kReflectance = 0.7;
constexpr double kPi = std::numbers::pi;

double Integral(double from, double to, int steps, const std::function<double(double)>& f) {
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += f(from + (i + 0.5) / steps * (to - from));
  return sum * (to - from) / steps;
}

// Both angles from the normal, toward one side.
double Lobe(double exponent, double out, double in) {
  const double alpha = in + out;
  if (std::abs(alpha) >= kPi / 2) return 0;
  const double integral = std::sqrt(kPi) * std::exp(std::lgamma(exponent / 2 + 1) - std::lgamma((exponent + 3) / 2));
  return kReflectance * std::pow(std::cos(alpha), exponent) / integral;
}

// A floor from (-1, 0) to (1, 0) that reflects; a point above it looks down to it.
constexpr Point2 kPoint{0.3, 0.8};

// Irradiance there from radiance that leaves the floor, by place and angle.
double OfFloor(int steps, const std::function<double(double x, double out)>& radiance) {
  return Integral(-1, 1, steps, [&](double x) {
    const double d = kPoint.x - x, r = std::hypot(d, kPoint.y);
    return radiance(x, std::atan2(d, kPoint.y)) * kPoint.y * kPoint.y / (r * r * r);
  });
}

void ExpectValue(SceneMaker maker, double exponent, double truth, double slack) {
  maker.Segment("floor", {-1, 0}, {1, 0}, PhongOf(kReflectance, exponent));
  maker.PointProbe(kPoint, {0, -1});
  for (const double target : {1e-2, 1e-5}) {
    const SolvedGloss solved = SolveGloss(maker.Build(), target);
    ASSERT_EQ(solved.state, GlossySolver::State::kReached) << exponent << ": " << solved.relative_error;
    const ExactValue& value = solved.values[0];
    EXPECT_LE(std::abs(value.irradiance[0] - truth), value.irradiance_error[0] + slack * truth) << exponent;
    EXPECT_LE(value.irradiance_error[0], target * value.irradiance[0]) << exponent;
  }
}

TEST(GlossyClosedFormsTest, AFloorShowsALamp) {
  for (const double exponent : {0.5, 1.0, 3.0, 20.0, 300.0}) {
    // Faces right, above the point's horizon; black, so light is reflected once.
    SceneMaker maker;
    maker.Segment("lamp", {-0.6, 1.5}, {-0.6, 0.9}, {.radiance = {2}});
    const double truth = OfFloor(600, [&](double x, double out) {
      if (x <= -0.6) return 0.0;
      return Integral(0.9, 1.5, 600, [&](double y) {
        const double d = x + 0.6, r = std::hypot(d, y);
        return 2 * Lobe(exponent, out, -std::atan2(d, y)) * (y / r) * (d / (r * r));
      });
    });
    ExpectValue(maker, exponent, truth, 2e-5);
  }
}

TEST(GlossyClosedFormsTest, AFloorShowsTheSky) {
  for (const double exponent : {0.5, 2.0, 50.0}) {
    SceneMaker maker;
    maker.Environment({1.5});
    const double reflected = OfFloor(1000, [&](double, double out) {
      return Integral(-kPi / 2, kPi / 2, 1000, [&](double in) { return 1.5 * Lobe(exponent, out, in) * std::cos(in); });
    });
    // What the point sees beside the floor, below its horizon.
    const auto sine = [](double x) { return (x - kPoint.x) / std::hypot(x - kPoint.x, kPoint.y); };
    const double sky = 1.5 * (2 - (sine(1) - sine(-1)));
    ExpectValue(maker, exponent, sky + reflected, 2e-5);
  }
}

TEST(GlossyClosedFormsTest, AFloorShowsLightsWithoutASurface) {
  for (const double exponent : {2.0, 40.0}) {
    SceneMaker maker;
    maker.Light(PointLightDescription{.position = {-0.4, 1.1}, .power = {3}});
    const double of_point = OfFloor(20000, [&](double x, double out) {
      const double d = -0.4 - x, r = std::hypot(d, 1.1);
      return 3 / (2 * kPi) * Lobe(exponent, out, std::atan2(d, 1.1)) * 1.1 / (r * r);
    });
    ExpectValue(maker, exponent, of_point, 1e-6);
    maker.Light(DirectionalLightDescription{.direction = {0.6, -0.8}, .irradiance = {2}});
    const double in = -std::atan2(0.6, 0.8);
    const double of_sun = OfFloor(20000, [&](double, double out) { return 2 * 0.8 * Lobe(exponent, out, in); });
    ExpectValue(maker, exponent, of_point + of_sun, 1e-6);
  }
}

// In a round room that shines alike everywhere the light of every place is the same, a function of direction alone,
// along whose chord it goes on: L(t) = integral of f(t, s) cos s (1 + L(s)) ds.
TEST(GlossyClosedFormsTest, ARoundRoomIsLitAlikeEverywhere) {
  for (const double exponent : {1.0, 30.0}) {
    constexpr int kSteps = 400;
    std::vector<double> light(kSteps, 0.0), next(kSteps);
    const auto angle = [](int i) { return kPi * ((i + 0.5) / kSteps - 0.5); };
    for (int round = 0; round < 80; ++round) {
      for (int i = 0; i < kSteps; ++i) {
        next[static_cast<std::size_t>(i)] = 0;
        for (int j = 0; j < kSteps; ++j) {
          // A chord leaves the other place to the other side.
          const double there = 1 + light[static_cast<std::size_t>(kSteps - 1 - j)];
          next[static_cast<std::size_t>(i)] +=
              kPi / kSteps * Lobe(exponent, angle(i), angle(j)) * std::cos(angle(j)) * there;
        }
      }
      light.swap(next);
    }
    double truth = 2;
    for (int j = 0; j < kSteps; ++j) truth += kPi / kSteps * std::cos(angle(j)) * light[static_cast<std::size_t>(j)];
    SceneMaker maker;
    Look look = PhongOf(kReflectance, exponent);
    look.radiance = {1};
    maker.Arc("room", {{0, 0}, 1, 0, 2 * kPi}, look).Probe("room", 5);
    const SolvedGloss solved = SolveGloss(maker.Build(), 1e-4);
    ASSERT_EQ(solved.state, GlossySolver::State::kReached);
    for (const ExactValue& value : solved.values)
      EXPECT_LE(std::abs(value.irradiance[0] - truth), value.irradiance_error[0] + 3e-5 * truth) << exponent;
  }
}

}  // namespace
}  // namespace flatlight
