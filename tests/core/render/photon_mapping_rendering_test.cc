// SPDX-License-Identifier: Apache-2.0
// The method `photon-mapping`: closed forms, agreement with other methods within stated errors, how errors fall.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/transport/mistakes.h"
#include "tests/support/transport/render.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

constexpr double kFullTurn = 2 * std::numbers::pi;

Settings Photons(std::uint32_t photons, bool final_gather, std::uint32_t seed = 0) {
  Settings settings;
  settings.method = Method::kPhotonMapping;
  settings.photons = photons;
  settings.final_gather = final_gather;
  settings.seed = seed;
  return settings;
}

std::vector<double> All(const Field& field, std::vector<double> ProbeField::*values) {
  std::vector<double> all;
  for (const ProbeField& probe : field.probes) all.insert(all.end(), (probe.*values).begin(), (probe.*values).end());
  return all;
}

// How far values are from the truth in standard errors, as far as they are farther than the stated bias and `slack`.
struct Deviation {
  double mean_square = 0;
  double largest = 0;
  double rms = 0;  // Of values, relative to their mean.
};

Deviation DeviationFrom(const std::vector<double>& truth, const Field& field, double slack = 0) {
  const std::vector<double> value = All(field, &ProbeField::irradiance);
  const std::vector<double> error = All(field, &ProbeField::standard_error);
  const std::vector<double> bias = All(field, &ProbeField::estimated_bias);
  EXPECT_EQ(value.size(), truth.size());
  const auto n = static_cast<double>(truth.size());
  Deviation deviation;
  double mean = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double off = std::abs(value[i] - truth[i]);
    const double beyond = std::max(off - bias[i] - slack, 0.0) / error[i];
    deviation.mean_square += beyond * beyond / n;
    deviation.largest = std::max(deviation.largest, beyond);
    deviation.rms += off * off / n;
    mean += truth[i] / n;
  }
  deviation.rms = std::sqrt(deviation.rms) / mean;
  return deviation;
}

std::vector<double> Reference(const std::shared_ptr<const Scene>& scene, std::optional<std::uint32_t> bounces = {}) {
  Settings settings;
  settings.method = Method::kReference;
  settings.derivatives = Derivatives::kNone;
  settings.max_bounces = bounces;
  return All(*Render(scene, settings).field, &ProbeField::irradiance);
}

// A room with a lamp, a blocker, a disc, and a wall that stands on the floor.
SceneMaker DividedRoom(std::uint32_t points) {
  SceneMaker maker = SquareRoom({.reflectance = {0.6}}, points);
  maker.Segment("lamp", {-0.4, 0.9}, {-0.8, 0.85}, {.radiance = {5}});
  maker.Segment("divider", {0.1, -1}, {0.1, 0.4}, {.reflectance = {0.3}});
  maker.Segment("blocker", {-0.7, 0.1}, {-0.4, 0.15}, {.reflectance = {0.5}});
  maker.Arc("disc", {{0.5, 0.3}, 0.15, 0, -kFullTurn}, {.reflectance = {0.7}});
  return maker;
}

// E = 2 L / (1 - rho) everywhere, up to the corners. Half of a kernel that reached over an end would be missing.
TEST(PhotonMappingTest, FurnacesAreEvenUpToTheirCorners) {
  for (const auto& room : {SquareRoom({.reflectance = {0.5}, .radiance = {1}}, 101),
                           SceneMaker()
                               .Arc("round", {{0, 0}, 1, 0.2, kFullTurn}, {.reflectance = {0.5}, .radiance = {1}})
                               .Probe("round", 101)}) {
    const auto scene = room.Build();
    const std::vector<double> truth(scene->traits().probe_points, 4);
    for (const bool gather : {false, true}) {
      const Deviation deviation = DeviationFrom(truth, *Render(scene, Photons(20000, gather)).field);
      EXPECT_LT(deviation.rms, gather ? 0.008 : 0.03);
      EXPECT_LT(deviation.largest, 8);
      EXPECT_LT(deviation.mean_square, 1.5);
    }
  }
}

// Evenly lit: read at the very ends as in the middle, by every kernel, width and rule.
TEST(PhotonMappingTest, AnEvenlyLitSegmentReadsConstantUpToItsEnds) {
  SceneMaker maker;
  maker.Segment("floor", {0, 0}, {4, 0}).Light(DirectionalLightDescription{{0, -1}, {3}});
  for (const double x : {0.0, 0.001, 0.1, 2.0, 3.9, 4.0}) maker.PointProbe({x, 0}, {0, 1});
  const auto scene = maker.Build();
  for (int rule = 0; rule < 3; ++rule) {
    for (const Kernel kernel : {Kernel::kBox, Kernel::kTriangle, Kernel::kEpanechnikov, Kernel::kBiweight}) {
      Settings settings = Photons(1 << 14, false);
      settings.kernel = kernel;
      if (rule == 1) settings.neighbours = 1000;
      if (rule == 2) settings.bandwidth = 0.3;
      const auto field = Render(scene, settings).field;
      for (const ProbeField& probe : field->probes)
        EXPECT_NEAR(probe.irradiance[0], 3, std::max(6 * probe.standard_error[0] + probe.estimated_bias[0], 1e-9));
      for (const ProbeField& probe : field->probes) EXPECT_LT(probe.standard_error[0], 0.1) << rule;
    }
  }
}

// Paths do not end by chance before little of their flux is left: 0.6^4 is more than 1/8.
TEST(PhotonMappingTest, PhotonsAreFollowedOn) {
  Settings settings = Photons(1000, false);
  settings.max_bounces = 4;
  const auto field = Render(SquareRoom({.reflectance = {0.6}, .radiance = {1}}, 4).Build(), settings).field;
  EXPECT_EQ(field->rays, 5000);
}

// All flux that is sent out arrives, and again as much of it as is reflected.
TEST(PhotonMappingTest, FluxIsConserved) {
  const auto scene = SquareRoom({.reflectance = {0.75}, .radiance = {1}}, 400).Build();
  double total = 0;
  const auto field = Render(scene, Photons(30000, false)).field;
  for (const ProbeField& probe : field->probes)
    for (const double irradiance : probe.irradiance) total += irradiance * 2 / 400;
  // 8 m emit 2 W/m, and light arrives 1 / (1 - 0.75) times.
  EXPECT_NEAR(total, 64, 0.3);
}

TEST(PhotonMappingTest, DensitiesAgreeWithExactLight) {
  SceneMaker maker;
  maker.Segment("floor", {-1, 0}, {2, 0}).Probe("floor", 100);
  maker.Segment("lamp", {1, 1}, {0, 1}, {.radiance = {2}}).Segment("plate", {0.5, 0.5}, {1.2, 0.5});
  maker.Light(PointLightDescription{{-0.5, 0.7}, {1}});
  maker.Light(SpotLightDescription{{1.5, 1.5}, {0, -1}, {2}, 0.2, 0.4}).Environment({0.2});
  const auto scene = maker.Build();
  Settings exact;
  exact.method = Method::kExact;
  const std::vector<double> truth = All(*Render(scene, exact).field, &ProbeField::irradiance);
  const Deviation deviation = DeviationFrom(truth, *Render(scene, Photons(200000, false)).field);
  EXPECT_LT(deviation.rms, 0.04);
  EXPECT_LT(deviation.mean_square, 3);
  // With a gather, light that comes straight is in closed form.
  Settings gather;
  gather.method = Method::kPhotonMapping;
  gather.final_gather = true;
  const std::vector<double> gathered = All(*Render(scene, gather).field, &ProbeField::irradiance);
  for (std::size_t i = 0; i < truth.size(); ++i) EXPECT_NEAR(gathered[i], truth[i], 1e-12);
}

TEST(PhotonMappingTest, AgreesWithTheReference) {
  const auto scene = DividedRoom(40).Build();
  for (const std::optional<std::uint32_t> bounces : {std::optional<std::uint32_t>(1), std::optional<std::uint32_t>()}) {
    const std::vector<double> truth = Reference(scene, bounces);
    for (const bool gather : {false, true}) {
      Settings settings = Photons(100000, gather);
      settings.max_bounces = bounces;
      const Deviation deviation = DeviationFrom(truth, *Render(scene, settings).field);
      EXPECT_LT(deviation.rms, gather ? 0.025 : 0.06) << gather;
      EXPECT_LT(deviation.mean_square, gather ? 1.3 : 3) << gather;
      EXPECT_LT(deviation.largest, gather ? 6 : 12) << gather;
    }
  }
}

// Few photons tell little of what they miss, and a standard error is small where a kernel is wide.
TEST(PhotonMappingTest, StatedErrorsHoldForFewPhotons) {
  const auto scene = DividedRoom(20).Build();
  const std::vector<double> truth = Reference(scene);
  constexpr int kSeeds = 6;
  for (const std::uint32_t photons : {100, 800, 6400}) {
    double mean_square = 0;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed)
      mean_square += DeviationFrom(truth, *Render(scene, Photons(photons, false, seed)).field).mean_square / kSeeds;
    EXPECT_LT(mean_square, 1.6) << photons;
  }
}

TEST(PhotonMappingTest, AgreesWithPathTracingAmongAllMaterialsAndLights) {
  SceneMaker maker = RoomOfAllMaterials();
  maker.Bezier("curtain", {{-0.8, 0.9}, {-0.5, 0.8}, {-0.9, 0.7}, {-0.85, 0.5}}, {.reflectance = {0.3, 0.2, 0.1}});
  maker.Probe("gloss", 12).Probe("mirror", 12).Probe("curtain", 12);
  const auto scene = maker.Build();
  for (const std::optional<std::uint32_t> bounces : {std::optional<std::uint32_t>(2), std::optional<std::uint32_t>()}) {
    Settings paths = Sampled(16384);
    paths.max_bounces = bounces;
    const auto truth = Render(scene, paths).field;
    const std::vector<double> values = All(*truth, &ProbeField::irradiance);
    const std::vector<double> noise = All(*truth, &ProbeField::standard_error);
    double slack = 0;
    for (const double error : noise) slack += error / static_cast<double>(noise.size());
    for (const bool gather : {false, true}) {
      Settings settings = Photons(200000, gather);
      settings.max_bounces = bounces;
      settings.samples = gather ? std::optional<std::uint32_t>(1024) : std::nullopt;
      const auto field = Render(scene, settings).field;
      const Deviation deviation = DeviationFrom(values, *field, slack);
      EXPECT_LT(deviation.rms, gather ? 0.03 : 0.12) << gather;
      EXPECT_LT(deviation.mean_square, gather ? 1.3 : 3) << gather;
    }
  }
}

// No ray finds this light: a point light over a mirror is one light more, behind it.
TEST(PhotonMappingTest, FindsWhatLightsSendOverMirrors) {
  SceneMaker maker;
  maker.Segment("floor", {-1, 0}, {1, 0}, {.reflectance = {0.5}}).Probe("floor", 41);
  maker.Segment("mirror", {1, -9}, {1, 9}, {.material = MirrorDescription{{0.8}}});
  maker.Light(PointLightDescription{{0.4, 1}, {std::numbers::pi}});  // 1/2 W/rad.
  const auto scene = maker.Build();
  const auto from = [](double x, double light, double intensity) {
    return intensity / (1 + (x - light) * (x - light));  // cos / r at height 1.
  };
  std::vector<double> truth;
  for (int i = 0; i < 41; ++i) {
    const double x = -1 + 2 * (i + 0.5) / 41;
    truth.push_back(from(x, 0.4, 0.5) + from(x, 1.6, 0.4));
  }
  const Deviation deviation = DeviationFrom(truth, *Render(scene, Photons(100000, false)).field);
  EXPECT_LT(deviation.rms, 0.012);
  EXPECT_LT(deviation.mean_square, 3);
  // With a gather it is found by the chains of mirrors, exactly, with its gradient and off all curves too.
  maker.PointProbe({0, 0.3}, {0, 1});
  const auto field = Render(maker.Build(), Photons(1000, true)).field;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double x = -1 + 2 * (static_cast<double>(i) + 0.5) / 41;
    EXPECT_NEAR(field->probes[0].irradiance[i], truth[i], 1e-9);
    const auto slope = [&](double light, double intensity) {
      return -2 * intensity * (x - light) / std::pow(1 + (x - light) * (x - light), 2);
    };
    EXPECT_NEAR(field->probes[0].gradient[i], slope(0.4, 0.5) + slope(1.6, 0.4), 1e-9);
  }
  EXPECT_NEAR(field->probes[1].irradiance[0], 0.5 * 0.7 / 0.65 + 0.4 * 0.7 / 3.05, 1e-9);
}

// Rays of a gather alone find a lamp in a mirror: photons have no part in it.
TEST(PhotonMappingTest, RaysOfAGatherGoByTheSeed) {
  SceneMaker maker;
  maker.Segment("floor", {-1, 0}, {1, 0}).Probe("floor", 10);
  maker.Segment("mirror", {1, 0}, {1, 2}, {.material = MirrorDescription{{0.8}}});
  maker.Segment("lamp", {0.3, 1}, {-0.3, 1}, {.radiance = {1}, .two_sided = true});
  const auto scene = maker.Build();
  Settings settings = Photons(100, true);
  settings.samples = 64;
  const auto first = Render(scene, settings).field;
  settings.seed = 1;
  const auto second = Render(scene, settings).field;
  int differ = 0;
  for (std::size_t i = 0; i < 10; ++i)
    differ += first->probes[0].irradiance[i] != second->probes[0].irradiance[i] ? 1 : 0;
  EXPECT_GE(differ, 8);
}

// Over mirrors, lamps are found by rays and lights without a surface by chains, and neither by both; and what a mirror
// shows has a bounce less to come from.
TEST(PhotonMappingTest, CountsLightOverMirrorsOnce) {
  SceneMaker maker;
  maker.Segment("floor", {-1, 0}, {1, 0}, {.reflectance = {0.9}}).Probe("floor", 40);
  maker.Segment("mirror", {2, 1}, {-2, 1}, {.material = MirrorDescription{{0.9}}});
  maker.Segment("gloss", {-1, 1}, {-1, 0}, {.material = PhongDescription{{0.8}, 10}});
  maker.Segment("lamp", {0.8, 0.3}, {0.4, 0.3}, {.radiance = {2}, .two_sided = true});
  maker.Light(PointLightDescription{{-0.4, 0.4}, {1}});
  const auto scene = maker.Build();
  for (const std::optional<std::uint32_t> bounces : {std::optional<std::uint32_t>(2), std::optional<std::uint32_t>()}) {
    Settings paths = Sampled(1u << 15);
    paths.max_bounces = bounces;
    const auto truth = Render(scene, paths).field;
    Settings settings = Photons(200000, true);
    settings.max_bounces = bounces;
    settings.samples = 2048;
    const auto field = Render(scene, settings).field;
    double noise = 0;
    for (const double error : truth->probes[0].standard_error) noise += error / 40;
    const Deviation deviation = DeviationFrom(truth->probes[0].irradiance, *field, noise);
    EXPECT_LT(deviation.rms, 0.01);
    EXPECT_LT(deviation.mean_square, 1.5);
  }
}

// However wide a kernel is, it does not reach through a wall, around a corner, or to the other side.
TEST(PhotonMappingTest, NothingLeaks) {
  SceneMaker maker;
  maker.Segment("floor", {-1, 0}, {1, 0}).Probe("floor", 100).Probe("floor", 100, Side::kBack);
  maker.Segment("wall", {0, 0}, {0, 3});
  maker.Segment("lamp", {-0.3, 1}, {-0.9, 1}, {.radiance = {1}});
  // A corner, one leg of which is parallel to the light.
  maker.Polyline("corner", {{5, 0}, {6, 0}, {6, -1}}, false).Probe("corner", 100);
  maker.Light(DirectionalLightDescription{{0, -1}, {1}});
  const auto scene = maker.Build();
  for (int rule = 0; rule < 3; ++rule) {
    Settings settings = Photons(4000, false);
    if (rule == 1) settings.bandwidth = 2;
    if (rule == 2) settings.neighbours = 2000;
    const auto field = Render(scene, settings).field;
    const std::size_t dark_before[] = {100, 0, 50};
    for (std::size_t p = 0; p < 3; ++p) {
      const Probe& probe = scene->probes()[p];
      for (std::size_t i = 0; i < probe.receivers.size(); ++i) {
        const bool lit = p == 0 ? true : p == 2 && i < dark_before[p];
        if (lit) {
          EXPECT_GT(field->probes[p].irradiance[i], 0) << rule << ' ' << p << ' ' << i;
        } else {
          EXPECT_EQ(field->probes[p].irradiance[i], 0) << rule << ' ' << p << ' ' << i;
        }
      }
    }
    // The lamp is on the left of the wall alone, and the sun on both sides.
    for (std::size_t i = 50; i < 100; ++i)
      EXPECT_NEAR(field->probes[0].irradiance[i], 1, 6 * field->probes[0].standard_error[i] + 1e-9) << rule;
  }
}

// Errors fall at least as photons^-0.4, and so do stated ones.
TEST(PhotonMappingTest, ErrorsFallWithPhotons) {
  const auto scene = UnitLight().Probe("floor", 100).Build();
  Settings exact;
  exact.method = Method::kExact;
  const std::vector<double> truth = All(*Render(scene, exact).field, &ProbeField::irradiance);
  const auto room = DividedRoom(30).Build();
  const std::vector<double> reference = Reference(room);
  const auto rms = [](const std::shared_ptr<const Scene>& of, const std::vector<double>& is, std::uint32_t photons) {
    double squares = 0;
    for (std::uint32_t seed = 0; seed < 6; ++seed) {
      const double one = DeviationFrom(is, *Render(of, Photons(photons, false, seed)).field).rms;
      squares += one * one / 6;
    }
    return std::sqrt(squares);
  };
  constexpr double kTimes = 256;
  EXPECT_LT(rms(scene, truth, 1000 * 256) / rms(scene, truth, 1000), std::pow(kTimes, -0.4));
  EXPECT_LT(rms(room, reference, 1000 * 256) / rms(room, reference, 1000), std::pow(kTimes, -0.4));
}

// Jarosz et al. 2012: of 100 photons a density is poor, and one gather of the same map near the truth.
TEST(PhotonMappingTest, AFinalGatherIsWorthManyPhotons) {
  SceneMaker maker = SquareRoom({.reflectance = {0.6}}, 40);
  maker.Segment("lamp", {0.4, 0.9}, {-0.4, 0.9}, {.radiance = {5}});
  maker.Arc("disc", {{0.4, -0.3}, 0.2, 0, -kFullTurn}, {.reflectance = {0.6}});
  const auto scene = maker.Build();
  const std::vector<double> truth = Reference(scene);
  double best = 1e9, gathered = 0;
  constexpr int kSeeds = 8;
  const auto mean_square = [&](Settings settings) {
    double squares = 0;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
      settings.seed = seed;
      const double rms = DeviationFrom(truth, *Render(scene, settings).field).rms;
      squares += rms * rms / kSeeds;
    }
    return squares;
  };
  for (const double bandwidth : {0.15, 0.3, 0.6, 1.2, 4.0}) {
    Settings settings = Photons(100, false);
    settings.bandwidth = bandwidth;
    best = std::min(best, mean_square(settings));
  }
  best = std::min(best, mean_square(Photons(100, false)));
  gathered = mean_square(Photons(100, true));
  EXPECT_GT(std::sqrt(best / gathered), 3);
}

TEST(PhotonMappingTest, GradientsAgreeWithTheReference) {
  // Of 20 points one would lie in line with the blocker, where the gradient jumps.
  const auto scene = DividedRoom(21).Build();
  Settings reference;
  reference.method = Method::kReference;
  reference.derivatives = Derivatives::kGradient;
  const std::vector<double> truth = All(*Render(scene, reference).field, &ProbeField::gradient);
  // Of few rays the error is that of their distance, which the spread of maps does not tell.
  for (const std::uint32_t rays : {512, 4096}) {
    Settings settings = Photons(200000, true);
    settings.samples = rays;
    const auto field = Render(scene, settings).field;
    const std::vector<double> gradient = All(*field, &ProbeField::gradient);
    const std::vector<double> error = All(*field, &ProbeField::gradient_error);
    double z_square = 0, size = 0, off = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double z = (gradient[i] - truth[i]) / error[i];
      z_square += z * z / static_cast<double>(truth.size());
      size += truth[i] * truth[i];
      off += (gradient[i] - truth[i]) * (gradient[i] - truth[i]);
    }
    EXPECT_LT(z_square, 2.5) << rays;
    EXPECT_LT(std::sqrt(off / size), rays < 4096 ? 0.1 : 0.03) << rays;
  }
}

TEST(PhotonMappingTest, ThreadsAndSlicesLeaveNoTrace) {
  const auto scene = FurnishedRoom(false, 8).Build();
  for (const bool gather : {false, true}) {
    for (const bool open_ended : {false, true}) {
      Settings settings = Photons(30000, gather);
      if (open_ended) settings.photons.reset(), settings.target_error = gather ? 0.1 : 0.5;
      const Ended once = Render(scene, settings);
      EXPECT_EQ(once.reason, open_ended ? EndReason::kTargetReached : EndReason::kSamplesDone);
      for (const int threads : {2, 7}) {
        const Ended again = Render(scene, settings, threads, std::chrono::microseconds(300));
        EXPECT_EQ(HashOf(*again.field), HashOf(*once.field)) << gather << open_ended;
      }
      settings.seed = 1;
      EXPECT_NE(HashOf(*Render(scene, settings).field), HashOf(*once.field));
    }
  }
}

// Passes beyond the largest one narrow what they resolve: memory is bounded, the error is not.
TEST(PhotonMappingTest, ManyPassesAreOneResult) {
  const auto scene = UnitLight().Probe("floor", 50).Build();
  Settings exact;
  exact.method = Method::kExact;
  const std::vector<double> truth = All(*Render(scene, exact).field, &ProbeField::irradiance);
  const auto field = Render(scene, Photons(700000, false)).field;
  EXPECT_EQ(field->photons, 700000);
  EXPECT_LT(DeviationFrom(truth, *field).rms, 0.004);
}

TEST(PhotonMappingTest, StopsWhenCancelledAndInTime) {
  const auto scene = DividedRoom(20).Build();
  Settings settings = Photons(100, true);
  settings.photons.reset();
  settings.time_limit = 0.05;
  const Ended ended = Render(scene, settings);
  EXPECT_EQ(ended.reason, EndReason::kTimeLimit);
  EXPECT_GT(*ended.field->photons, 0);
  Cancellation cancelled;
  cancelled.Cancel();
  const auto rendering = StartRendering(scene, PlanFor(*scene, Photons(1000, true)));
  InlineExecutor executor;
  rendering->Advance(executor, cancelled, SteadyClock(), kForever);
  EXPECT_FALSE(rendering->done());
  EXPECT_TRUE(rendering->Snapshot()->probes[0].irradiance.empty());
}

TEST(PhotonMappingTest, DarkScenesAreDark) {
  for (const bool gather : {false, true}) {
    const Ended ended = Render(SquareRoom({.reflectance = {0.5}}, 10).Build(), Photons(100, gather));
    for (const ProbeField& probe : ended.field->probes)
      for (const double value : probe.irradiance) EXPECT_EQ(value, 0);
  }
}

TEST(PhotonMappingTest, SettingsThatItWouldIgnoreAreMistakes) {
  const auto scene = SquareRoom({.reflectance = {0.5}, .radiance = {1}}, 4).Build();
  Settings settings = Photons(0, false);
  settings.samples = 16;
  settings.bandwidth = -1;
  settings.neighbours = 1;
  settings.derivatives = Derivatives::kGradient;
  EXPECT_THAT(Mistakes(*scene, settings),
              UnorderedElementsAre(HasSubstr("settings.photons: is 0"), HasSubstr("settings.bandwidth: is -1 m"),
                                   HasSubstr("settings.neighbours: is 1, must be at least 2"),
                                   HasSubstr("settings.neighbours: is given together"),
                                   HasSubstr("settings.samples: are rays of a final gather"),
                                   HasSubstr("settings.derivatives: come from a final gather")));
  settings = Photons(100, true);
  settings.derivatives = Derivatives::kHessian;
  EXPECT_THAT(Mistakes(*scene, settings),
              UnorderedElementsAre(HasSubstr("photon-mapping gives the Hessian of direct")));
  Settings other = Sampled(16);
  other.photons = 5, other.final_gather = true, other.bandwidth = 1, other.neighbours = 5, other.kernel = Kernel::kBox;
  EXPECT_THAT(Mistakes(*scene, other), testing::Each(HasSubstr("applies to photon-mapping alone")));
  EXPECT_EQ(Mistakes(*scene, other).size(), 5u);
  EXPECT_THAT(Mistakes(*UnitLight().PointProbe({0, 0.5}, {0, 1}).Build(), Photons(100, false)),
              UnorderedElementsAre(HasSubstr("points that lie on no curve")));
  EXPECT_THAT(Mistakes(*UnitLight().Probe("floor", 3).Build(), Photons(100, true)),
              UnorderedElementsAre(HasSubstr("settings.photons: does not apply: without reflection")));
}

}  // namespace
}  // namespace flatlight
