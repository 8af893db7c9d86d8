// SPDX-License-Identifier: Apache-2.0
// Direct light by sampling against direct light in closed form, for emitters of all shapes in all positions.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "core/plane/exact/exact.h"
#include "core/plane/path_tracing/path_tracer.h"
#include "tests/support/transport/honest_errors.h"
#include "tests/support/transport/scene_maker.h"
#include "tests/support/transport/trace.h"

namespace flatlight {
namespace {

// Segments and arcs thrown about, emitting on one side or both, or not; probes on the first few, on both sides.
SceneMaker Scatter(std::uint64_t seed, int curves) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(-1, 1);
  std::uniform_real_distribution<double> unit(0, 1);
  SceneMaker maker;
  for (int i = 0; i < curves; ++i) {
    Look look;
    if (i % 2 == 0) look = {.radiance = {0.2 + unit(random)}, .two_sided = unit(random) < 0.3};
    const std::string name = "curve " + std::to_string(i);
    const Point2 a{place(random), place(random)};
    if (unit(random) < 0.5) {
      maker.Segment(name, a, a + Vector2{0.7 * place(random), 0.7 * place(random)}, look);
    } else {
      const double sweep = unit(random) < 0.3 ? 2 * std::numbers::pi : 6 * unit(random) + 0.1;
      maker.Arc(name, {a, 0.05 + 0.4 * unit(random), 6 * unit(random), unit(random) < 0.5 ? sweep : -sweep}, look);
    }
    if (i < 3) maker.Probe(name, 2).Probe(name, 2, Side::kBack);
  }
  return maker;
}

void Compare(std::uint64_t scenes, int curves, double factor, HonestErrors& errors) {
  for (std::uint64_t seed = 0; seed < scenes; ++seed) {
    const std::shared_ptr<const Scene> scene = Scatter(seed, curves).Build();
    const auto caster = std::make_shared<const RayCaster>(scene);
    PathTracingOptions options;
    options.max_bounces = 0;
    const PathTracer tracer(caster, options);
    ExactSolver exact(*scene, caster->bvh(), {.derivatives = 0});
    std::uint64_t point = 0;
    for (const Probe& probe : scene->probes()) {
      for (const Receiver& receiver : probe.receivers) {
        const double truth = exact.Evaluate(receiver).irradiance[0] * scene->frame().radiance_scale;
        const MeanEstimate estimate = Trace(tracer, *scene, receiver, seed, point++, 64, factor);
        if (truth == 0) {
          EXPECT_EQ(estimate.mean, 0) << seed;
          continue;
        }
        EXPECT_LT(std::abs(estimate.mean - factor * truth), 8 * estimate.StandardError())
            << "scene " << seed << " point " << point - 1 << ": " << estimate.mean << " for " << truth;
        errors.Add(estimate.mean, truth, estimate.StandardError());
      }
    }
  }
}

// The mean of z is bounded as in HonestErrors. Its mean square is below 1 in direct light, where much is free of noise;
// the error must never be too small.
TEST(DirectLightTest, AgreesWithClosedFormWhereEmittersAreWeighed) {
  HonestErrors errors;
  Compare(60, 8, 1, errors);
  EXPECT_GT(errors.count(), 300u);
  EXPECT_TRUE(errors.Unbiased()) << errors.MeanZ();
  EXPECT_LT(errors.MeanSquareZ(), 1.3);
}

TEST(DirectLightTest, AgreesWithClosedFormWhereATreeChoosesEmitters) {
  HonestErrors errors;
  Compare(25, 50, 1, errors);
  EXPECT_TRUE(errors.Unbiased()) << errors.MeanZ();
  EXPECT_LT(errors.MeanSquareZ(), 1.3);
}

TEST(DirectLightTest, TwoPercentTooMuchIsNoticed) {
  HonestErrors errors;
  Compare(60, 8, 1.02, errors);
  EXPECT_FALSE(errors.Unbiased()) << errors.MeanZ();
}

// On its chord, to rounding, an arc is all that is seen, with its ends at the horizon: whichever side of them rounding
// puts a point.
TEST(DirectLightTest, FromItsChordAnArcIsAllThereIs) {
  for (int turn = 0; turn < 40; ++turn) {
    const double start = 0.37 * turn, sweep = turn % 3 == 0 ? 0.5 * std::numbers::pi : 0.3 + 0.03 * turn;
    SceneMaker maker;
    maker.Arc("lamp", {{0.2, -0.1}, 0.7, start, sweep}, {.radiance = {1}});
    const auto end = [&](double angle) { return Point2{0.2 + 0.7 * std::cos(angle), -0.1 + 0.7 * std::sin(angle)}; };
    maker.Segment("chord", end(start), end(start + sweep)).Probe("chord", 3, Side::kBack);
    const std::shared_ptr<const Scene> scene = maker.Build();
    const auto caster = std::make_shared<const RayCaster>(scene);
    PathTracingOptions options;
    options.max_bounces = 0;
    const PathTracer tracer(caster, options);
    for (std::uint64_t point = 0; point < 3; ++point) {
      const MeanEstimate estimate = Trace(tracer, *scene, scene->probes()[0].receivers[point], 5, point, 64, 1);
      EXPECT_NEAR(estimate.mean, 2, 8 * estimate.StandardError() + 1e-12) << turn;
      EXPECT_LT(estimate.StandardError(), 0.2) << turn;
    }
  }
}

// A sliver of a lamp around the wall, within 1e-9 of both of its sides: one side of the sliver fills all that the point
// sees, the end and the other side lie at the horizon, in directions whose sines are one number.
TEST(DirectLightTest, ALampWithinAtomsOfBothSidesOfAWall) {
  SceneMaker maker;
  maker.Segment("wall", {0.9047148973282422, -0.04535382662716032}, {0.12914159131129976, 0.06568286175296961})
      .Polyline("sliver",
                {{0.980266014793399, -0.056170272},
                 {0.06570422785949415, 0.0747650146171},
                 {0.0657042278019, 0.074765014},
                 {0.980266014736, -0.056170272}},
                false, {.radiance = {1}})
      .Probe("wall", 2, Side::kBack);
  const std::shared_ptr<const Scene> scene = maker.Build();
  const auto caster = std::make_shared<const RayCaster>(scene);
  for (const bool leave_out_shadow_rays : {false, true}) {
    PathTracingOptions options;
    options.max_bounces = 0;
    options.leave_out_shadow_rays = leave_out_shadow_rays;
    const PathTracer tracer(caster, options);
    EXPECT_NEAR(Trace(tracer, *scene, scene->probes()[0].receivers[1], 5, 0, 64, 1).mean, 2, 1e-14);
  }
}

}  // namespace
}  // namespace flatlight
