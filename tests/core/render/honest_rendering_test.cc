// SPDX-License-Identifier: Apache-2.0
// Errors that renderings state, against truths in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/render/rendering.h"
#include "tests/support/transport/honest_errors.h"
#include "tests/support/transport/render.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

// A furnace with much noise; 16 points, 40 seeds: 640 values.
TEST(HonestRenderingTest, StatedErrorsTellTheTruth) {
  const auto scene = SquareRoom({.reflectance = {0.6}, .radiance = {1}}, 4).Build();
  HonestErrors errors;
  HonestErrors wrong;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    const Ended ended = Render(scene, Sampled(256, seed));
    for (const ProbeField& probe : ended.field->probes) {
      for (std::size_t i = 0; i < probe.irradiance.size(); ++i) {
        errors.Add(probe.irradiance[i], 5, probe.standard_error[i]);
        wrong.Add(1.02 * probe.irradiance[i], 5, probe.standard_error[i]);
      }
    }
  }
  EXPECT_EQ(errors.count(), 640u);
  EXPECT_TRUE(errors.Unbiased()) << errors.MeanZ();
  EXPECT_TRUE(errors.RightSize()) << errors.MeanSquareZ();
  EXPECT_FALSE(wrong.Unbiased()) << "2 % more light must be noticed";
}

// As few paths as there can be, of which few are long: 4 walls of 32 points, 20 seeds.
TEST(HonestRenderingTest, SixteenPathsKnowTheirErrorFromTheirNeighbours) {
  const auto scene = SquareRoom({.reflectance = {0.8}, .radiance = {1}}, 32).Build();
  HonestErrors errors;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const Ended ended = Render(scene, Sampled(16, seed));
    for (const ProbeField& probe : ended.field->probes) {
      for (std::size_t i = 0; i < probe.irradiance.size(); ++i) {
        errors.Add(probe.irradiance[i], 10, probe.standard_error[i]);
      }
    }
  }
  EXPECT_EQ(errors.count(), 2560u);
  EXPECT_TRUE(errors.RightSize()) << errors.MeanSquareZ();
}

// A slit in the roof of a black room, which most rays miss: 32 points, 20 seeds. What none found is in the error.
TEST(HonestRenderingTest, SkyThatNoPathFoundIsInTheError) {
  SceneMaker maker;
  maker.Polyline("room", {{-0.01, 1}, {-1, 1}, {-1, 0}, {1, 0}, {1, 1}, {0.01, 1}}, false, {.reflectance = {0}});
  maker.Environment({5});
  for (int i = 0; i < 32; ++i) maker.PointProbe({-0.97 + 0.06 * i, 0}, {0, 1});
  const auto scene = maker.Build();
  Settings exact;
  exact.method = Method::kExact;
  exact.max_bounces = 0;
  const std::shared_ptr<const Field> truth = Render(scene, exact).field;
  HonestErrors errors;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const Ended ended = Render(scene, Sampled(16, seed));
    for (std::size_t p = 0; p < ended.field->probes.size(); ++p) {
      const ProbeField& probe = ended.field->probes[p];
      errors.Add(probe.irradiance[0], truth->probes[p].irradiance[0], probe.standard_error[0]);
    }
  }
  EXPECT_LT(errors.MeanSquareZ(), 1.5);
}

// A furnace for each channel: E = 2 Le / (1 - rho).
TEST(HonestRenderingTest, ChannelsAreIndependent) {
  const std::vector<double> reflectance = {0.2, 0.5, 0.7};
  const std::vector<double> radiance = {1, 3, 0.5};
  const auto scene = SquareRoom({.reflectance = reflectance, .radiance = radiance}, 4).Build();
  std::array<HonestErrors, 3> errors;
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const Ended ended = Render(scene, Sampled(128, seed));
    for (const ProbeField& probe : ended.field->probes) {
      ASSERT_EQ(probe.irradiance.size(), 12u);
      for (std::size_t i = 0; i < 12; ++i) {
        const std::size_t c = i % 3;
        errors[c].Add(probe.irradiance[i], 2 * radiance[c] / (1 - reflectance[c]), probe.standard_error[i]);
      }
    }
  }
  for (const HonestErrors& channel : errors) EXPECT_TRUE(channel.Unbiased()) << channel.MeanZ();
}

// A point on a corner of a dark room, and one at the foot of a wall: light must not come in through the wall that
// touches the point.
TEST(HonestRenderingTest, PointsOnOtherCurvesAreOnTheSideOfIncreasingArcLength) {
  const auto room = SceneMaker()
                        .Segment("left", {0, 1}, {0, 0}, {.reflectance = {0}})
                        .Segment("floor", {0, 0}, {1, 0}, {.reflectance = {0}})
                        .Segment("right", {1, 0}, {1, 1}, {.reflectance = {0}})
                        .Segment("roof", {1, 1}, {0, 1}, {.reflectance = {0}})
                        .Segment("lamp", {-1, -3}, {-1, 3}, {.reflectance = {0}, .radiance = {1}, .two_sided = true})
                        .PointProbe({0, 0}, {0, 1})
                        .Build();
  EXPECT_EQ(Render(room, Sampled(256, 0)).field->probes[0].irradiance[0], 0);
  const auto wall = SceneMaker()
                        .Segment("floor", {-2, 0}, {2, 0}, {.reflectance = {0}})
                        .Segment("lamp", {1, 2}, {-1, 2}, {.reflectance = {0}, .radiance = {1}})
                        .Segment("wall", {0, 0}, {0, 1}, {.reflectance = {0}})
                        .Probe("floor", 1)
                        .Build();
  const ProbeField field = Render(wall, Sampled(1024, 0)).field->probes[0];
  EXPECT_NEAR(field.irradiance[0], 1 / std::sqrt(5.0), 4 * field.standard_error[0]);
}

// The same as StatedErrorsTellTheTruth for points that stop by themselves, each when it meets the target.
TEST(HonestRenderingTest, TargetErrorIsMetWithoutBias) {
  const auto scene = SquareRoom({.reflectance = {0.6}, .radiance = {1}}, 4).Build();
  HonestErrors errors;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    Settings settings;
    settings.seed = seed;
    settings.target_error = 0.02;
    const Ended ended = Render(scene, settings);
    EXPECT_EQ(ended.reason, EndReason::kTargetReached);
    for (const ProbeField& probe : ended.field->probes) {
      double mean = 0;
      for (const double e : probe.irradiance) mean += e / static_cast<double>(probe.irradiance.size());
      for (std::size_t i = 0; i < probe.irradiance.size(); ++i) {
        EXPECT_LE(probe.standard_error[i], 0.02 * std::max(probe.irradiance[i], 0.01 * mean));
        EXPECT_GE(probe.samples[i], 64);
        errors.Add(probe.irradiance[i], 5, probe.standard_error[i]);
      }
    }
  }
  EXPECT_TRUE(errors.Unbiased()) << errors.MeanZ();
}

// Two chambers; only paths through a slit between them reach the lit one from the other.
SceneMaker Keyhole() {
  SceneMaker maker;
  maker.Segment("floor", {0, 0}, {4, 0}, {.reflectance = {0.7}});
  maker.Polyline("walls", {{4, 0}, {4, 1}, {0, 1}, {0, 0}}, false, {.reflectance = {0.7}});
  maker.Segment("lower wall", {2, 0}, {2, 0.46}, {.reflectance = {0.3}});
  maker.Segment("upper wall", {2, 0.54}, {2, 1}, {.reflectance = {0.3}});
  maker.Segment("lamp", {3.9, 0.9}, {3.7, 0.9}, {.radiance = {50}});
  return maker;
}

// Rare and bright. The mean over many seeds is the truth, as a long rendering knows it, and stated errors have the
// right size.
TEST(HonestRenderingTest, StoppingAtATargetDoesNotBiasRareBrightLight) {
  const auto scene = Keyhole().PointProbe({0.7, 0.05}, {0, 1}).Build();
  const Ended truth = Render(scene, Sampled(1 << 17, 1000));
  const double mean = truth.field->probes[0].irradiance[0];
  const double doubt = truth.field->probes[0].standard_error[0];
  double sum = 0;
  double squares = 0;
  HonestErrors errors;
  constexpr int kRuns = 200;
  for (std::uint32_t seed = 0; seed < kRuns; ++seed) {
    Settings settings;
    settings.seed = seed;
    settings.target_error = 0.3;
    const ProbeField field = Render(scene, settings).field->probes[0];
    const double difference = field.irradiance[0] - mean;
    sum += difference;
    squares += difference * difference;
    errors.Add(field.irradiance[0], mean, std::hypot(field.standard_error[0], doubt));
  }
  const double variance = squares + kRuns * kRuns * doubt * doubt;
  EXPECT_LT(std::abs(sum), 5 * std::sqrt(variance)) << sum / kRuns << " of " << mean;
  EXPECT_TRUE(errors.RightSize()) << errors.MeanSquareZ();
}

// The same along a floor that runs through both chambers: 16 points, 30 seeds.
TEST(HonestRenderingTest, StatedErrorsTellTheTruthThroughAKeyhole) {
  const auto scene = Keyhole().Probe("floor", 16).Build();
  const ProbeField truth = Render(scene, Sampled(1 << 15, 1000)).field->probes[0];
  HonestErrors errors;
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    Settings settings;
    settings.seed = seed;
    settings.target_error = 0.2;
    const ProbeField field = Render(scene, settings).field->probes[0];
    for (std::size_t i = 0; i < field.irradiance.size(); ++i) {
      errors.Add(field.irradiance[i], truth.irradiance[i],
                 std::hypot(field.standard_error[i], truth.standard_error[i]));
    }
  }
  EXPECT_TRUE(errors.RightSize()) << errors.MeanSquareZ();
}

// Where paths seldom find the only curve that reflects, few samples say nothing of what it gives: fixed counts, of
// which most find nothing. Their errors may be stated too large, not too small.
TEST(HonestRenderingTest, LightThatNoSampleFoundIsInTheError) {
  SceneMaker maker;
  maker.Segment("floor", {0, 0}, {1, 0}, {.reflectance = {0.5}});
  maker.Segment("lamp", {1, 1}, {0, 1}, {.radiance = {2}});
  maker.Segment("mirror", {3, 0}, {3, 0.3}, {.reflectance = {0.9}});
  maker.PointProbe({0.2, 0}, {0, 1});
  const auto scene = maker.Build();
  const ProbeField truth = Render(scene, Sampled(1 << 16, 1000)).field->probes[0];
  HonestErrors errors;
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    const ProbeField field = Render(scene, Sampled(32, seed)).field->probes[0];
    errors.Add(field.irradiance[0], truth.irradiance[0], std::hypot(field.standard_error[0], truth.standard_error[0]));
  }
  EXPECT_LT(errors.MeanSquareZ(), 1);
}

// A free point exactly where two pieces of floor meet, whose directions agree to 1e-8: rays must leave both of them.
TEST(HonestRenderingTest, AFloorOfTwoPiecesIsAsLitAsOneAtItsJoint) {
  const Point2 joint{-0.4595569065160034, 0.2181846216735593};
  SceneMaker maker;
  maker.Segment("after", joint, {-0.45096422995486884, 0.379220286681});
  maker.Segment("before", {-0.48533494, -0.26492}, joint);
  maker.Segment("lamp", {1, 0.8}, {0.4, -0.6}, {.radiance = {1}, .two_sided = true});
  maker.PointProbe(joint, {1.28828532006, -0.0687414124891});
  const auto scene = maker.Build();
  Settings exact;
  exact.max_bounces = 0;
  const double truth = Render(scene, exact).field->probes[0].irradiance[0];
  EXPECT_GT(truth, 1);
  EXPECT_NEAR(Render(scene, Sampled(64)).field->probes[0].irradiance[0], truth, 1e-9);
}

// A dark circle that stands on the floor at the probe covers it: to the left of the circle's foot as to the right, but
// toward increasing arc length it must not be seen from inside.
TEST(HonestRenderingTest, ACircleThatTouchesThePointIsSeenFromOutside) {
  for (const double radius : {0.357787840871518, 0.25, 0.6}) {
    SceneMaker maker;
    maker.Segment("floor", {-2, -1.5}, {2, -1.5});
    maker.Arc("circle", {{-0.30213267, -1.5 + radius}, radius, -2, 2 * std::numbers::pi}, {.radiance = {1}});
    maker.PointProbe({-0.30213267, -1.5}, {0, 1});
    EXPECT_EQ(Render(maker.Build(), Sampled(1024)).field->probes[0].irradiance[0], 0) << radius;
  }
}

// A free point on a lamp, facing along it: just beyond, on the lamp's front, it sees the half of it that lies ahead.
TEST(HonestRenderingTest, ALampThroughThePointIsNotTakenForUnseen) {
  SceneMaker maker;
  maker.Segment("lamp", {-0.9, -1}, {-0.9, -0.4}, {.radiance = {1}});
  maker.PointProbe({-0.9, -0.5}, {0, -1});
  const ProbeField field = Render(maker.Build(), Sampled(64)).field->probes[0];
  EXPECT_NEAR(field.irradiance[0], 1, 1e-9);
}

// At the crest of a ridge a lamp so low on the horizon that rays to it pass the crest nearer than curves that touch:
// they miss it, and say so.
TEST(HonestRenderingTest, WhatRaysMissAtTheHorizonOfACornerIsStated) {
  SceneMaker maker;
  maker.Polyline("ridge", {{-0.8, -0.6}, {0, 0}, {1, 0}}, false).Probe("ridge", 1);
  maker.Segment("lamp", {-1, 5e-4}, {-1, 0}, {.radiance = {1}});
  const std::shared_ptr<const Scene> scene = maker.Build();
  const ProbeField field = Render(scene, Sampled(1024)).field->probes[0];
  EXPECT_NEAR(field.irradiance[0], 1.25e-7, 6 * field.standard_error[0]);
  EXPECT_LT(field.standard_error[0], 1e-6);
  // Rotation misses more than irradiance.
  Settings settings = Sampled(1 << 15);
  settings.method = Method::kRayTracing;
  settings.derivatives = Derivatives::kGradient;
  const ProbeField turned = Render(scene, settings).field->probes[0];
  EXPECT_NEAR(turned.rotation_gradient[0], -5e-4, 2 * turned.rotation_gradient_error[0]);
  EXPECT_LT(turned.rotation_gradient_error[0], 2e-3);
}

}  // namespace
}  // namespace flatlight
