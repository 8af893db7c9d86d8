// SPDX-License-Identifier: Apache-2.0
// Paths over mirrors, glass and gloss, and light of lights without a surface, against closed forms and quadrature.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include "core/plane/materials/fresnel.h"
#include "core/plane/materials/scattering.h"
#include "core/plane/path_tracing/path_tracer.h"
#include "tests/support/transport/honest_errors.h"
#include "tests/support/transport/scene_maker.h"
#include "tests/support/transport/trace.h"

namespace flatlight {
namespace {

// For t_15 scaled to variance 1: once in 1e5 estimates; seeds are fixed.
constexpr double kMostZ = 6;
constexpr double kFullTurn = 2 * std::numbers::pi;

MeanEstimate Estimate(const SceneMaker& maker, std::uint32_t samples, std::optional<std::uint32_t> max_bounces = {},
                      std::size_t probe = 0) {
  const auto scene = maker.Build();
  PathTracingOptions options;
  options.max_bounces = max_bounces;
  const PathTracer tracer(std::make_shared<const RayCaster>(scene), options);
  return Trace(tracer, *scene, scene->probes()[probe].receivers[0], 1, probe, samples);
}

void ExpectNear(const MeanEstimate& estimate, double truth) {
  EXPECT_LE(std::abs(estimate.mean - truth), kMostZ * estimate.StandardError() + 1e-12 * truth)
      << estimate.mean << " +- " << estimate.StandardError() << ", truth " << truth;
  EXPECT_LE(estimate.StandardError(), 0.05 * truth);
}

double Integral(double from, double to, int steps, const std::function<double(double)>& f) {
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += f(from + (i + 0.5) / steps * (to - from));
  return sum * (to - from) / steps;
}

SpectrumValues Grey(double value) { return {value}; }

// A lamp above the point faces a long mirror on the point's right: the point sees the lamp's image, at x = 3 to 4.
TEST(MaterialsTest, FlatMirrorShowsAnImage) {
  SceneMaker maker;
  maker.Segment("lamp", {1, 1}, {0, 1}, {.radiance = {2}, .two_sided = true});
  maker.Segment("mirror", {2, 0}, {2, 3}, {.material = MirrorDescription{Grey(0.7)}});
  maker.PointProbe({0, 0}, {0, 1});
  const double direct = 1 / std::hypot(1, 1), image = 4 / std::hypot(4, 1) - 3 / std::hypot(3, 1);
  ExpectNear(Estimate(maker, 256, 0u), 2 * direct);
  ExpectNear(Estimate(maker, 4096), 2 * (direct + 0.7 * image));
}

// Between two parallel mirrors the images go on for ever.
TEST(MaterialsTest, FacingMirrorsShowAllImages) {
  SceneMaker maker;
  maker.Segment("lamp", {0.2, 1}, {-0.2, 1}, {.radiance = {1}, .two_sided = true});
  maker.Segment("right", {1, -40}, {1, 40}, {.material = MirrorDescription{Grey(0.8)}});
  maker.Segment("left", {-1, -40}, {-1, 40}, {.material = MirrorDescription{Grey(0.8)}});
  maker.PointProbe({0, 0}, {0, 1});
  const auto sine = [](double x) { return x / std::hypot(x, 1); };
  double all = 2 * sine(0.2), five = all;
  for (int k = 1; k < 200; ++k) {
    // The lamp hides what goes through it; images are of the side that is seen, and the lamp has no thickness.
    const double image = 2 * std::pow(0.8, k) * (sine(2 * k + 0.2) - sine(2 * k - 0.2));
    all += image;
    if (k <= 5) five += image;
  }
  ExpectNear(Estimate(maker, 8192), all);
  ExpectNear(Estimate(maker, 8192, 5u), five);
}

// In a furnace nothing that keeps light can be seen: L = Le/(1 - rho) everywhere, and n times as much in glass.
TEST(MaterialsTest, FurnaceHidesGlassAndMirrors) {
  SceneMaker maker = SquareRoom({.reflectance = {0.6}, .radiance = {0.4}}, 1);
  maker.Arc("ball", {{0.3, -0.2}, 0.35, 0, -kFullTurn}, {.material = DielectricDescription{1.5}});
  maker.Arc("bubble", {{0.3, -0.2}, 0.1, 0, kFullTurn}, {.material = DielectricDescription{1.5}});
  maker.Segment("mirror", {-0.8, -0.5}, {-0.3, 0.6}, {.material = MirrorDescription{Grey(1)}});
  maker.PointProbe({0.3, 0.0}, {0.6, 0.8});   // In the glass.
  maker.PointProbe({0.3, -0.2}, {0.6, 0.8});  // In the bubble.
  maker.PointProbe({-0.5, -0.5}, {1, 0});     // Beside the mirror.
  ExpectNear(Estimate(maker, 2048, {}, 0), 2);
  ExpectNear(Estimate(maker, 2048, {}, 4), 2 * 1.5);
  ExpectNear(Estimate(maker, 2048, {}, 5), 2);
  ExpectNear(Estimate(maker, 2048, {}, 6), 2);
}

// A sky over still water (THEORY 17 A6): radiance grows by the index, the critical angle cuts it off.
TEST(MaterialsTest, SkyUnderWater) {
  SceneMaker maker;
  maker.Segment("water", {1000, 0}, {-1000, 0}, {.material = DielectricDescription{1 / 1.5}});
  maker.Segment("ground", {-1000, -1}, {1000, -1});
  maker.Environment({1});
  maker.PointProbe({0, -0.01}, {0, 1});
  maker.PointProbe({0, 0.01}, {0, 1});
  const double truth = Integral(-1, 1, 20000, [](double sine_above) {
    const LocalDirection above{sine_above, std::sqrt(1 - sine_above * sine_above)};
    return 1 - SplitAtBorder(above, 1.5).reflected;
  });
  EXPECT_NEAR(truth, 1.86405, 1e-5);
  ExpectNear(Estimate(maker, 8192), truth);
  ExpectNear(Estimate(maker, 16, {}, 1), 2);
}

// A lamp, a glossy wall and a point, once around, by quadrature over the wall and the lamp.
void ExpectGlossyReflection(const MaterialKind& description, const Material& material) {
  SceneMaker maker;
  maker.Segment("lamp", {0.4, 2}, {-0.4, 1.5}, {.radiance = {3}});
  maker.Segment("wall", {2, 0}, {2, 2}, {.material = description});
  maker.PointProbe({0, 0}, {0.6, 0.8});
  const Scattering scattering(material, Side::kFront);
  const double reflected = Integral(0, 2, 500, [&](double y) {
    const double distance = std::hypot(2, y);
    const LocalDirection out{-y / distance, 2 / distance};  // The wall's normal is -x, its tangent (n.y, -n.x) = +y.
    const double cosine = (0.6 * 2 + 0.8 * y) / distance;
    const double geometry = cosine * out.cosine / distance;
    return geometry * Integral(0, 1, 500, [&](double u) {
             const double x = 0.4 - 0.8 * u, h = 2 - 0.5 * u;
             const double dx = 2 - x, dy = h - y, r = std::hypot(dx, dy);
             const LocalDirection in{dy / r, dx / r};
             const double length = std::hypot(0.8, 0.5);
             const double emitter_cosine = (0.5 * dx + -0.8 * -dy) / length / r;  // Front of the lamp: (0.5, -0.8).
             if (!(emitter_cosine > 0)) return 0.0;
             return 3 * scattering.Value(out, in)[0] * in.cosine * emitter_cosine / r * length;
           });
  });
  const double direct = Integral(0, 1, 500, [](double u) {
    const double x = 0.4 - 0.8 * u, h = 2 - 0.5 * u, r = std::hypot(x, h), length = std::hypot(0.8, 0.5);
    const double emitter_cosine = (-0.5 * x + 0.8 * h) / length / r;
    return 3 * (0.6 * x + 0.8 * h) / r * emitter_cosine / r * length;
  });
  ASSERT_GT(reflected, 0.02);
  ExpectNear(Estimate(maker, 16384, 1u), direct + reflected);
}

TEST(MaterialsTest, PhongByQuadrature) {
  for (const double exponent : {0.5, 8.0, 60.0})
    ExpectGlossyReflection(PhongDescription{Grey(0.9), exponent}, Phong{Spectrum::Grey(0.9), exponent});
}

TEST(MaterialsTest, ConductorByQuadrature) {
  for (const double roughness : {0.3, 0.6, 1.0})
    ExpectGlossyReflection(ConductorDescription{Grey(0.9), roughness},
                           Conductor{Spectrum::Grey(0.9), roughness * roughness});
}

TEST(MaterialsTest, ExtremesAreTheSimplerMaterials) {
  const auto estimate = [](MaterialKind kind) {
    SceneMaker maker;
    maker.Segment("lamp", {0.4, 2}, {-0.4, 1.5}, {.radiance = {3}});
    maker.Segment("wall", {2, 0}, {2, 2}, {.material = std::move(kind)});
    maker.PointProbe({0, 0}, {0.6, 0.8});
    return Estimate(maker, 64).mean;
  };
  EXPECT_EQ(estimate(PhongDescription{Grey(0.9), 0}), estimate(LambertianDescription{Grey(0.9)}));
  EXPECT_EQ(estimate(ConductorDescription{Grey(0.9), 0}), estimate(MirrorDescription{Grey(0.9)}));
}

// Light that glass has caught goes around for ever; such paths must end.
TEST(MaterialsTest, CaughtLightEnds) {
  SceneMaker maker;
  maker.Arc("ring", {{0, 0}, 1, 0, -kFullTurn}, {.material = DielectricDescription{2}});
  maker.Environment({1});
  maker.PointProbe({0.9, 0}, {0, 1});
  // From within a disc of index 2 a point at 0.9 sees the sky in directions up to asin(1/2) from the radial one there:
  // what reaches it is what it would send out, without loss or gain; the rest is dark.
  // A line through (0.9, 0) with the sine s from the vertical passes the centre at 0.9 cos: it must be below 1/2.
  ExpectNear(Estimate(maker, 4096), 2 * 2 * (1 - std::sqrt(1 - std::pow(0.5 / 0.9, 2))));
}

TEST(MaterialsTest, PointLightsFallOffWithDistance) {
  SceneMaker maker;
  maker.Light(PointLightDescription{{1, 2}, {10}});
  maker.PointProbe({0, 0}, {0, 1});
  maker.Segment("shade", {-1, 1}, {0.2, 1});
  maker.PointProbe({-1, 0}, {0, 1});
  EXPECT_NEAR(Estimate(maker, 1).mean, 10 / kFullTurn * 2 / 5, 1e-14);
  EXPECT_EQ(Estimate(maker, 1, {}, 1).mean, 0);
}

TEST(MaterialsTest, SpotsKeepTheirPower) {
  SceneMaker maker;
  maker.Light(SpotLightDescription{{0.1, 0.2}, {3, 4}, {5}, 0.3, 0.8});
  maker.Arc("screen", {{0, 0}, 1, 0, kFullTurn});
  maker.Probe("screen", 4000);
  const auto scene = maker.Build();
  const PathTracer tracer(std::make_shared<const RayCaster>(scene), {});
  double sum = 0;
  for (const Receiver& receiver : scene->probes()[0].receivers) sum += Trace(tracer, *scene, receiver, 1, 0, 1).mean;
  EXPECT_NEAR(sum * kFullTurn / 4000, 5, 1e-5);
}

TEST(MaterialsTest, DirectionalLightFollowsTheCosine) {
  SceneMaker maker;
  maker.Light(DirectionalLightDescription{{3, -4}, {10}});
  maker.PointProbe({0, 0}, {0, 1});
  maker.Segment("shade", {-4, 4}, {-2, 4});
  maker.PointProbe({0, 2},
                   {0, 1});  // Light comes along (-3, 4): over (-1.5, 4) past the shade, over (-3, 4) it does not.
  EXPECT_EQ(Estimate(maker, 1).mean, 0);
  EXPECT_NEAR(Estimate(maker, 1, {}, 1).mean, 8, 1e-14);
}

// The light of seven is the sum of the light of each, though only one is asked at a time.
TEST(MaterialsTest, ManyLightsAreChosenFairly) {
  SceneMaker maker = SquareRoom({.reflectance = {0.5}}, 1);
  double sum = 0, variance = 0;
  for (int i = 0; i < 7; ++i) {
    const PointLightDescription light{{-0.6 + 0.2 * i, 0.5 - 0.1 * i}, {1.0 + i}};
    maker.Light(light);
    SceneMaker alone = SquareRoom({.reflectance = {0.5}}, 1);
    alone.Light(light);
    const MeanEstimate estimate = Estimate(alone, 1024);
    sum += estimate.mean;
    variance += estimate.StandardError() * estimate.StandardError();
  }
  const MeanEstimate all = Estimate(maker, 4096);
  EXPECT_LE(std::abs(all.mean - sum), kMostZ * std::hypot(all.StandardError(), std::sqrt(variance)));
  EXPECT_LE(all.StandardError(), 0.02 * sum);
}

// Power that goes in is absorbed: in a closed room the integral of E (1 - rho) over the walls.
TEST(MaterialsTest, RoomsAbsorbThePowerOfTheirLights) {
  SceneMaker maker = SquareRoom({.reflectance = {0.5}}, 200);
  maker.Light(PointLightDescription{{0.3, 0.1}, {3}});
  maker.Light(DirectionalLightDescription{{1, 1}, {7}});  // Which does not get in.
  const auto scene = maker.Build();
  const PathTracer tracer(std::make_shared<const RayCaster>(scene), {});
  double absorbed = 0, variance = 0;
  for (std::size_t probe = 0; probe < 4; ++probe) {
    for (std::size_t i = 0; i < 200; ++i) {
      const MeanEstimate e = Trace(tracer, *scene, scene->probes()[probe].receivers[i], 1, probe * 200 + i, 64);
      absorbed += 0.5 * 0.01 * e.mean;
      variance += 0.005 * 0.005 * e.StandardError() * e.StandardError();
    }
  }
  // The midpoint rule of 200 points errs by less than 1e-4 for light that is smooth along each wall.
  EXPECT_NEAR(absorbed, 3, kMostZ * std::sqrt(variance) + 1e-3);
  EXPECT_LT(std::sqrt(variance), 0.003);
}

}  // namespace
}  // namespace flatlight
