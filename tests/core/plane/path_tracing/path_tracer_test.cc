// SPDX-License-Identifier: Apache-2.0
// Scenes whose irradiance is known in closed form (THEORY 16).
#include "core/plane/path_tracing/path_tracer.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "tests/support/transport/honest_errors.h"
#include "tests/support/transport/scene_maker.h"
#include "tests/support/transport/trace.h"

namespace flatlight {
namespace {

// A single estimate is a failure beyond 6 stated errors: for t_15 scaled to variance 1 that happens once in 1e5
// estimates; seeds are fixed.
constexpr double kMostZ = 6;

struct Traced {
  explicit Traced(const SceneMaker& maker, PathTracingOptions options = {})
      : scene(maker.Build()), tracer(std::make_shared<const RayCaster>(scene), options) {}

  const Receiver& receiver(std::size_t probe = 0, std::size_t point = 0) const {
    return scene->probes()[probe].receivers[point];
  }
  MeanEstimate At(std::size_t probe, std::uint64_t seed, std::uint32_t samples, double factor = 1) const {
    return Trace(tracer, *scene, receiver(probe), seed, probe, samples, factor);
  }

  std::shared_ptr<const Scene> scene;
  PathTracer tracer;
};

void ExpectNear(const MeanEstimate& estimate, double truth) {
  EXPECT_LE(std::abs(estimate.mean - truth), kMostZ * estimate.StandardError())
      << estimate.mean << " +- " << estimate.StandardError() << ", truth " << truth;
}

TEST(PathTracerTest, UnblockedStraightLightIsFreeOfNoise) {
  SceneMaker maker = UnitLight();
  for (const double x : {0.05, 0.3, 0.5, 1.7}) maker.PointProbe({x, 0.01}, {0, 1});
  const Traced traced(maker);
  std::size_t probe = 0;
  for (const double x : {0.05, 0.3, 0.5, 1.7}) {
    const double h = 0.99;
    const MeanEstimate estimate = traced.At(probe++, 1, 4);
    EXPECT_NEAR(estimate.mean, (1 - x) / std::hypot(1 - x, h) + x / std::hypot(x, h), 1e-12);
    EXPECT_LT(std::sqrt(estimate.variance), 1e-12);
  }
}

TEST(PathTracerTest, BlockerCastsAPenumbra) {
  SceneMaker maker = UnitLight();
  maker.Segment("blocker", {0.5, 0.5}, {1.2, 0.5});
  maker.PointProbe({0.3, 0}, {0, 1});
  const double truth = 0.3 / std::hypot(0.3, 1) + 0.4 / std::hypot(0.4, 1);  // Light seen between x = 0 and 0.7.
  ExpectNear(Traced(maker).At(0, 1, 256), truth);
}

// From a disc of radiance L: 2 L cos(theta) R / D.
TEST(PathTracerTest, DiscFollowsItsLaw) {
  SceneMaker maker;
  maker.Arc("disc", {{0.5, 2}, 0.3, 0, -2 * std::numbers::pi}, {.radiance = {3}});
  maker.PointProbe({0, 0}, {0, 1});
  const double distance = std::hypot(0.5, 2);
  ExpectNear(Traced(maker).At(0, 1, 256), 2 * 3 * (2 / distance) * 0.3 / distance);
}

TEST(PathTracerTest, OneSidedEmittersAreDarkBehind) {
  SceneMaker maker;
  maker.Segment("up", {0, 1}, {1, 1}, {.radiance = {1}});
  maker.PointProbe({0.5, 0}, {0, 1});
  maker.PointProbe({0.5, 2}, {0, -1});
  const Traced traced(maker);
  EXPECT_EQ(traced.At(0, 1, 64).mean, 0);
  EXPECT_NEAR(traced.At(1, 1, 64).mean, 2 * 0.5 / std::hypot(0.5, 1), 1e-12);

  SceneMaker both;
  both.Segment("up", {0, 1}, {1, 1}, {.radiance = {1}, .two_sided = true});
  both.PointProbe({0.5, 0}, {0, 1});
  EXPECT_NEAR(Traced(both).At(0, 1, 64).mean, 2 * 0.5 / std::hypot(0.5, 1), 1e-12);
}

// A closed room emitting Le everywhere: L = Le / (1 - rho), E = 2 L.
TEST(PathTracerTest, FurnaceGlowsEvenly) {
  for (const double reflectance : {0.0, 0.3, 0.5, 0.9, 0.99}) {
    const Traced square(SquareRoom({.reflectance = {reflectance}, .radiance = {1}}, 1));
    SceneMaker ring_maker;
    ring_maker.Arc("ring", {{5, 5}, 2, 1, 2 * std::numbers::pi}, {.reflectance = {reflectance}, .radiance = {1}});
    ring_maker.Probe("ring", 1);
    const Traced ring(ring_maker);
    HonestErrors errors;
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
      for (const Traced* room : {&square, &ring}) {
        const MeanEstimate estimate = room->At(0, seed, 8);
        errors.Add(estimate.mean, 2 / (1 - reflectance), estimate.StandardError());
      }
    }
    EXPECT_TRUE(errors.Unbiased()) << reflectance << ": " << errors.MeanZ();
  }
}

// With at most k reflections E = 2 Le (1 + rho + ... + rho^k). At this reflectance no path is light enough for
// roulette, and the room leaves no other noise.
TEST(PathTracerTest, EachBounceAddsItsOrder) {
  const SceneMaker maker = SquareRoom({.reflectance = {0.8}, .radiance = {1}}, 1);
  double truth = 0;
  for (std::uint32_t bounces = 0; bounces <= 5; ++bounces) {
    truth += 2 * std::pow(0.8, bounces);
    PathTracingOptions options;
    options.max_bounces = bounces;
    EXPECT_NEAR(Traced(maker, options).At(0, 1, 16).mean, truth, 1e-12 * truth) << bounces;
  }
}

// Roulette sets in: a dark room over many orders, limited far beyond where light has faded, and unlimited.
TEST(PathTracerTest, RouletteKeepsTheMean) {
  for (const std::optional<std::uint32_t> bounces :
       {std::optional<std::uint32_t>(40), std::optional<std::uint32_t>()}) {
    PathTracingOptions options;
    options.max_bounces = bounces;
    const Traced room(SquareRoom({.reflectance = {0.35}, .radiance = {1}}, 1), options);
    HonestErrors errors;
    HonestErrors wrong;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
      const MeanEstimate estimate = room.At(seed % 4, seed, 16);
      errors.Add(estimate.mean, 2 / 0.65, estimate.StandardError());
      const MeanEstimate scaled = room.At(seed % 4, seed, 16, 1.02);
      wrong.Add(scaled.mean, 2 / 0.65, scaled.StandardError());
    }
    EXPECT_TRUE(errors.Unbiased()) << errors.MeanZ();
    EXPECT_TRUE(errors.RightSize()) << errors.MeanSquareZ();
    EXPECT_FALSE(wrong.Unbiased()) << "2 % more light must be noticed";
  }
}

// A light over a reflecting floor, both seen from beside. One bounce, against an integral by the midpoint rule. Curves
// reflect on both sides, so the floor may run either way.
TEST(PathTracerTest, OneBounceAgreesWithQuadratureOnEitherSide) {
  const auto floor_irradiance = [](double x) { return 2 * ((1 - x) / std::hypot(1 - x, 1) + x / std::hypot(x, 1)); };
  // The floor has radiance rho E / 2; the point sees it, and the light's front, by the sine of the angle.
  double bounced = 0;
  constexpr int kSteps = 20'000;
  for (int i = 0; i < kSteps; ++i) {
    const double x = (i + 0.5) / kSteps;
    const double dx = 1.5 - x;
    const double r2 = dx * dx + 0.25;
    bounced += 0.3 * floor_irradiance(x) * (dx * 0.5 / (r2 * std::sqrt(r2))) / kSteps;
  }
  const double direct = 2 * (0.5 / std::hypot(0.5, 0.5) - 0.5 / std::hypot(1.5, 0.5));
  for (const bool front_up : {true, false}) {
    SceneMaker maker;
    maker.Segment("light", {1, 1}, {0, 1}, {.radiance = {2}});
    maker.Segment("floor", {front_up ? 0.0 : 1.0, 0}, {front_up ? 1.0 : 0.0, 0}, {.reflectance = {0.6}});
    maker.PointProbe({1.5, 0.5}, {-1, 0});
    PathTracingOptions options;
    options.max_bounces = 1;
    HonestErrors errors;
    const Traced traced(maker, options);
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
      const MeanEstimate estimate = traced.At(0, seed, 64);
      errors.Add(estimate.mean, direct + bounced, estimate.StandardError());
    }
    EXPECT_TRUE(errors.Unbiased()) << errors.MeanZ();
  }
}

TEST(PathTracerTest, ReflectanceNearOneEndsAndStaysUnbiased) {
  const Traced room(SquareRoom({.reflectance = {0.999}, .radiance = {1}}, 1));
  HonestErrors errors;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const MeanEstimate estimate = room.At(seed, seed, 1);
    errors.Add(estimate.mean, 2000, estimate.StandardError());
  }
  EXPECT_TRUE(errors.Unbiased()) << errors.MeanZ();
}

TEST(PathTracerTest, CancellationEndsAPathAtItsNextVertex) {
  const Traced room(SquareRoom({.reflectance = {0.9999}, .radiance = {1}}, 1));
  Cancellation cancelled;
  cancelled.Cancel();
  double rays = 0;
  std::array<double, kMaxChannels> value{};
  const PathTracer::Start start(room.tracer, room.receiver(), {});
  room.tracer.AddPath(start, SampleStream(0, 0, 0), 0, cancelled, value, rays);
  EXPECT_EQ(rays, 0);
}

}  // namespace
}  // namespace flatlight
