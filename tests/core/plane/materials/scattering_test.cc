// SPDX-License-Identifier: Apache-2.0
#include "core/plane/materials/scattering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "core/plane/materials/fresnel.h"

namespace flatlight {
namespace {

constexpr double kHalfPi = std::numbers::pi / 2;

LocalDirection At(double angle) { return {std::sin(angle), std::cos(angle)}; }

struct Named {
  std::string name;
  Material material;
};

// Those with a BRDF.
std::vector<Named> Rough() {
  const Spectrum colour{{0.9, 0.5, 0.1}};
  std::vector<Named> all = {{"lambertian", Lambertian{colour}}};
  for (const double exponent : {0.01, 0.5, 1.0, 2.0, 7.5, 50.0, 1000.0})
    all.push_back({"phong " + std::to_string(exponent), Phong{colour, exponent}});
  for (const double alpha : {1e-3, 0.01, 0.1, 0.5, 1.0})
    all.push_back({"conductor " + std::to_string(alpha), Conductor{colour, alpha}});
  return all;
}

std::vector<double> OutAngles() { return {-1.55, -1.2, -0.8, 0, 0.1, 0.8, 1.3, 1.55}; }

// By the composite trapezoidal rule in t, with angle = peak + width sinh(t): fine at the peak.
double Integral(double from, double to, double peak, double width, const std::function<double(double)>& f) {
  const double t0 = std::asinh((from - peak) / width), t1 = std::asinh((to - peak) / width);
  constexpr int kSteps = 20000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double t = t0 + (i + 0.5) / kSteps * (t1 - t0);
    sum += f(peak + width * std::sinh(t)) * width * std::cosh(t);
  }
  return sum * (t1 - t0) / kSteps;
}

double Width(const Material& material) {
  if (const auto* phong = std::get_if<Phong>(&material)) return 1 / std::sqrt(1 + phong->exponent);
  if (const auto* conductor = std::get_if<Conductor>(&material)) return conductor->alpha;
  return 1;
}

double Albedo(const Material& material, double out) {
  const Scattering scattering(material, Side::kFront);
  return Integral(-kHalfPi, kHalfPi, -out, Width(material),
                  [&](double in) { return scattering.Value(At(out), At(in))[0] * std::cos(in); });
}

TEST(ScatteringTest, IsReciprocal) {
  for (const auto& [name, material] : Rough()) {
    const Scattering scattering(material, Side::kFront);
    for (const double out : OutAngles())
      for (const double in : {-1.5, -0.3, 0.2, 0.9}) {
        for (int c = 0; c < kMaxChannels; ++c) {
          const double there = scattering.Value(At(out), At(in))[c];
          EXPECT_NEAR(there, scattering.Value(At(in), At(out))[c], 1e-12 * there) << name;
        }
      }
  }
}

TEST(ScatteringTest, MakesNoLight) {
  for (const auto& [name, material] : Rough())
    for (const double out : OutAngles()) EXPECT_LE(Albedo(material, out), 0.9 * (1 + 1e-6)) << name << " at " << out;
}

TEST(ScatteringTest, ReflectsWhatItSays) {
  for (const double out : OutAngles()) EXPECT_NEAR(Albedo(Lambertian{Spectrum::Grey(0.7)}, out), 0.7, 1e-8) << out;
  for (const double exponent : {0.01, 0.5, 1.0, 50.0, 1000.0})
    EXPECT_NEAR(Albedo(Phong{Spectrum::Grey(0.7), exponent}, 0), 0.7, 1e-6) << exponent;
  // Light between facets is lost: values of THEORY 18 B10, 17 A5.
  EXPECT_NEAR(Albedo(Conductor{Spectrum::Grey(1), 0.1}, 0), 0.994, 6e-4);
  EXPECT_NEAR(Albedo(Conductor{Spectrum::Grey(1), 0.5}, 0), 0.82, 6e-3);
  EXPECT_NEAR(Albedo(Conductor{Spectrum::Grey(1), 1}, 0), 0.53, 6e-3);
  EXPECT_NEAR(Albedo(Phong{Spectrum::Grey(1), 1}, 1.5), 0.35, 6e-3);
  EXPECT_NEAR(Albedo(Phong{Spectrum::Grey(1), 50}, 1.5), 0.10, 6e-3);
  EXPECT_NEAR(Albedo(Phong{Spectrum::Grey(1), 0.01}, 0.8), 0.85, 6e-3);
}

TEST(ScatteringTest, SamplesHaveTheStatedDensityAndWeight) {
  std::mt19937_64 random(7);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  constexpr int kBins = 40;
  constexpr int kSamples = 200000;
  int tests = 0;
  for (const auto& [name, material] : Rough()) {
    const Scattering scattering(material, Side::kFront);
    const double width = Width(material);
    for (const double out : {-1.4, 0.3}) {
      SCOPED_TRACE(name + " at " + std::to_string(out));
      // Bins fine at the peak, and one more for what is worth nothing.
      const double t0 = std::asinh((-kHalfPi + out) / width), t1 = std::asinh((kHalfPi + out) / width);
      std::vector<double> expected(kBins + 1, 0), counted(kBins + 1, 0);
      const auto edge = [&](int i) { return -out + width * std::sinh(t0 + i * (t1 - t0) / kBins); };
      double reflected = 0;
      for (int i = 0; i < kBins; ++i) {
        expected[static_cast<std::size_t>(i)] = kSamples * Integral(edge(i), edge(i + 1), -out, width, [&](double in) {
                                                  return scattering.Density(At(out), At(in));
                                                });
        reflected += expected[static_cast<std::size_t>(i)];
      }
      EXPECT_LE(reflected, kSamples * (1 + 1e-6));
      expected[kBins] = kSamples - reflected;
      double weight = 0, square = 0;
      for (int n = 0; n < kSamples; ++n) {
        const auto sample = scattering.Sample(At(out), uniform(), uniform());
        std::size_t bin = kBins;
        if (sample.has_value()) {
          ASSERT_GT(sample->in.cosine, 0);
          ASSERT_NEAR(sample->in.cosine * sample->in.cosine + sample->in.sine * sample->in.sine, 1, 1e-12);
          const double density = scattering.Density(At(out), sample->in);
          ASSERT_NEAR(sample->density, density, 1e-9 * density);
          const double value = scattering.Value(At(out), sample->in)[1];
          ASSERT_NEAR(sample->weight[1], value * sample->in.cosine / density, 1e-9 * sample->weight[1]);
          weight += sample->weight[0];
          square += sample->weight[0] * sample->weight[0];
          const double t = std::asinh((std::atan2(sample->in.sine, sample->in.cosine) + out) / width);
          bin = static_cast<std::size_t>(std::clamp((t - t0) / (t1 - t0) * kBins, 0.0, kBins - 1.0));
        }
        ++counted[bin];
      }
      double chi = 0;
      int degrees = -1;
      double rest_expected = 0, rest_counted = 0;
      for (std::size_t i = 0; i <= kBins; ++i) {
        if (expected[i] < 10) {
          rest_expected += expected[i], rest_counted += counted[i];
          continue;
        }
        chi += (counted[i] - expected[i]) * (counted[i] - expected[i]) / expected[i];
        ++degrees;
      }
      if (rest_expected >= 10) {
        chi += (rest_counted - rest_expected) * (rest_counted - rest_expected) / rest_expected;
        ++degrees;
      } else {
        // Poisson of mean below 10 exceeds 35 with chance 1e-9.
        EXPECT_LE(rest_counted, 35);
      }
      // Wilson and Hilferty: the cube root is nearly normal. 5 standard deviations: chance 3e-7 each.
      const double v = 2.0 / (9.0 * degrees);
      EXPECT_LE((std::cbrt(chi / degrees) - (1 - v)) / std::sqrt(v), 5) << chi << " of " << degrees;
      const double mean = weight / kSamples;
      const double deviation = std::sqrt(std::max(square / kSamples - mean * mean, 0.0) / kSamples);
      EXPECT_NEAR(mean, Albedo(material, out), 5 * deviation + 1e-6);
      ++tests;
    }
  }
  EXPECT_EQ(tests, 26);
}

TEST(ScatteringTest, MirrorThrowsBackAtTheSameAngle) {
  const auto sample = Scattering(Mirror{{{0.9, 0.5, 0.1}}}, Side::kBack).Sample(At(0.4), 0.3, 0.6);
  ASSERT_TRUE(sample.has_value());
  EXPECT_DOUBLE_EQ(sample->in.sine, -std::sin(0.4));
  EXPECT_DOUBLE_EQ(sample->in.cosine, std::cos(0.4));
  EXPECT_EQ(sample->weight, (Spectrum{{0.9, 0.5, 0.1}}));
  EXPECT_EQ(sample->density, 0);
  EXPECT_EQ(sample->compression, 1);
}

TEST(FresnelTest, ClosedForms) {
  EXPECT_NEAR(SplitAtBorder(At(0), 1.5).reflected, 0.04, 1e-15);
  EXPECT_NEAR(SplitAtBorder(At(1.2), 1).reflected, 0, 1e-15);
  // At Brewster's angle only one polarisation is reflected: half of sin^2(difference of the angles).
  const double brewster = std::atan(1.5);
  EXPECT_NEAR(SplitAtBorder(At(brewster), 1.5).reflected, 0.5 * std::pow(std::sin(2 * brewster - kHalfPi), 2), 1e-15);
  EXPECT_EQ(SplitAtBorder(At(0.8), 1 / 1.5).reflected, 1);  // Beyond asin(1/1.5) = 0.7297.
  EXPECT_LT(SplitAtBorder(At(0.72), 1 / 1.5).reflected, 1);
  const FresnelSplit split = SplitAtBorder(At(0.5), 1.5);
  EXPECT_DOUBLE_EQ(split.transmitted.sine, -std::sin(0.5) / 1.5);
  EXPECT_LT(split.transmitted.cosine, 0);
}

TEST(FresnelTest, BothWaysLoseTheSame) {
  for (const double ratio : {0.2, 0.7, 1.3, 2.4, 10.0}) {
    for (double angle = -1.5; angle < 1.55; angle += 0.1) {
      const FresnelSplit there = SplitAtBorder(At(angle), ratio);
      if (there.reflected == 1) continue;
      const LocalDirection arriving{-there.transmitted.sine, -there.transmitted.cosine};
      const FresnelSplit back = SplitAtBorder(arriving, 1 / ratio);
      EXPECT_NEAR(there.reflected, back.reflected, 1e-13);
      EXPECT_NEAR(std::abs(back.transmitted.sine), std::abs(std::sin(angle)), 1e-14);
    }
  }
}

TEST(ScatteringTest, BorderSplitsByChance) {
  const Scattering glass(Dielectric{1.5}, Side::kFront);
  const double reflected = SplitAtBorder(At(0.9), 1.5).reflected;
  const auto above = glass.Sample(At(0.9), reflected * (1 - 1e-9), 0);
  const auto below = glass.Sample(At(0.9), reflected * (1 + 1e-9), 0);
  EXPECT_GT(above->in.cosine, 0);
  EXPECT_EQ(above->compression, 1);
  EXPECT_LT(below->in.cosine, 0);
  EXPECT_DOUBLE_EQ(below->compression, 1 / 1.5);  // Seen from outside, light from within is thinner.
  EXPECT_DOUBLE_EQ(Scattering(Dielectric{1.5}, Side::kBack).Sample(At(0.1), 0.9, 0)->compression, 1.5);
}

}  // namespace
}  // namespace flatlight
