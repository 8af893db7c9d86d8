// SPDX-License-Identifier: Apache-2.0
#include "core/plane/photon_mapping/photon_maps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "core/execution/executor.h"
#include "core/plane/photon_mapping/width_choice.h"
#include "core/plane/ray_caster.h"
#include "core/sampling/hash.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;
constexpr std::uint32_t kAny = std::numeric_limits<std::uint32_t>::max();

std::array<double, kReplicates> OnePath() {
  std::array<double, kReplicates> paths;
  paths.fill(1);
  return paths;
}

// Photons of flux 1 at places that `quantile` makes of numbers in [0, 1).
template <typename Quantile>
PhotonMaps::Photons Strewn(std::size_t each, SideId side, std::uint64_t key, Quantile quantile) {
  PhotonMaps::Photons photons;
  for (std::size_t r = 0; r < kReplicates; ++r) {
    for (std::size_t i = 0; i < each; ++i)
      photons[r].push_back({side, quantile(ToUnitInterval(ChildKey(ChildKey(key, r), i))), Spectrum::Grey(1), 0});
  }
  return photons;
}

// The mean over replicates.
double Mean(const PhotonMaps& maps, const DensityWindow& window, PhotonMaps::Width width = PhotonMaps::Width::kFirst) {
  double sum = 0;
  for (std::size_t r = 0; r < kReplicates; ++r) sum += maps.Density(r, window, width, kAny)[0] / kReplicates;
  return sum;
}

struct Line {
  std::shared_ptr<const Scene> scene = SceneMaker().Segment("line", {0, 0}, {1, 0}).Probe("line", 1).Build();
  Stretches stretches{*scene};
  SideId side{0};
  double length = stretches.length(side);
  InlineExecutor executor;
};

// k photons of which the last is at the width itself have a density of k - 1 over the measure, in the mean. All k of
// them would read 10 / 9 of it.
TEST(PhotonMapsTest, NearestPhotonsAreNoBias) {
  Line line;
  DensityOptions options;
  options.neighbours = 10;
  for (const Kernel kernel : {Kernel::kBox, Kernel::kEpanechnikov}) {
    options.kernel = kernel;
    for (const double fraction : {0.5, 0.0, 0.03}) {
      const double at = fraction * line.length;
      double sum = 0, squares = 0, other = 0;
      constexpr int kTrials = 3000;
      for (int trial = 0; trial < kTrials; ++trial) {
        const auto key = static_cast<std::uint64_t>(1000 * static_cast<int>(kernel) + trial);
        PhotonMaps::Photons photons =
            Strewn(25, line.side, ChildKey(7, key), [&](double u) { return u * line.length; });
        const PhotonMaps maps(line.stretches, std::move(photons), OnePath(), options, line.executor, 1);
        const DensityWindow window = maps.WindowAt({line.side, at});
        const double density = Mean(maps, window) * line.length / 25;
        sum += density / kTrials, squares += density * density / kTrials;
        other += Mean(maps, window, PhotonMaps::Width::kOther) * line.length / 25 / kTrials;
      }
      const double error = std::sqrt((squares - sum * sum) / kTrials);
      // 400 photons are no Poisson process: (k - 1) / k of one more is missing, 1/400.
      EXPECT_NEAR(sum, 1, 5 * error + 0.004) << fraction;
      EXPECT_LT(5 * error, 0.08);
      EXPECT_NEAR(other, 1, 5 * error + 0.004) << fraction;
    }
  }
}

// A box kernel by prefix sums, and by counting.
TEST(PhotonMapsTest, BoxKernelsCountPhotons) {
  Line line;
  const PhotonMaps::Photons photons = Strewn(500, line.side, 3, [&](double u) { return u * u * line.length; });
  DensityOptions options;
  options.kernel = Kernel::kBox;
  options.bandwidth = 0.07 * line.length;
  const PhotonMaps maps(line.stretches, photons, OnePath(), options, line.executor, 1);
  for (const double fraction : {0.0, 0.02, 0.3, 0.77, 0.98, 1.0}) {
    const double at = fraction * line.length, width = *options.bandwidth;
    const DensityWindow window = maps.WindowAt({line.side, at});
    EXPECT_EQ(window.width, width);
    const EndedKernel kernel(Kernel::kBox, -at / width, (line.length - at) / width);
    for (std::size_t r = 0; r < kReplicates; ++r) {
      double sum = 0;
      for (const Photon& photon : photons[r])
        if (std::abs(photon.at - at) < width) sum += kernel((photon.at - at) / width) / width;
      EXPECT_NEAR(maps.Density(r, window, PhotonMaps::Width::kFirst, kAny)[0], sum, 1e-9 * (1 + sum)) << fraction;
    }
  }
}

TEST(PhotonMapsTest, PhotonsReachAroundACircleAndNotToItsOtherSide) {
  const auto scene = SceneMaker().Arc("circle", {{0, 0}, 1, 0, kFullTurn}).Probe("circle", 1).Build();
  const Stretches stretches(*scene);
  const SideId front{0}, back{1};
  const double length = stretches.length(front);
  InlineExecutor executor;
  PhotonMaps::Photons photons;
  for (std::vector<Photon>& of : photons) {
    for (int i = 0; i < 100; ++i) of.push_back({front, (i + 0.5) / 100 * length, Spectrum::Grey(1), 0});
  }
  for (const auto kernel : {Kernel::kBox, Kernel::kTriangle, Kernel::kBiweight}) {
    DensityOptions options;
    options.kernel = kernel;
    options.bandwidth = 0.1 * length;
    const PhotonMaps maps(stretches, photons, OnePath(), options, executor, 1);
    for (const double at : {0.0, 0.001, 0.5, 0.97, 1.0}) {
      EXPECT_NEAR(Mean(maps, maps.WindowAt({front, at * length})) * length, 100, 1) << at;
      EXPECT_EQ(Mean(maps, maps.WindowAt({back, at * length})), 0);
    }
    options.bandwidth.reset();
    options.neighbours = 160;
    const PhotonMaps nearest(stretches, photons, OnePath(), options, executor, 1);
    EXPECT_NEAR(nearest.WindowAt({front, 0}).width, 0.045 * length, 0.006 * length);
    EXPECT_NEAR(Mean(nearest, nearest.WindowAt({front, 0})) * length, 100, 3);
  }
}

// E'' is constant: two widths tell the bias of the first.
TEST(PhotonMapsTest, TwoWidthsTellTheBias) {
  Line line;
  DensityOptions options;
  options.kernel = Kernel::kBox;
  options.bandwidth = 0.2 * line.length;
  // Density 3 (s/l)^2 of 200000 photons.
  constexpr std::size_t kEach = 12500;
  const auto cube_root = [&](double u) { return std::cbrt(u) * line.length; };
  const PhotonMaps maps(line.stretches, Strewn(kEach, line.side, 11, cube_root), OnePath(), options, line.executor, 1);
  const auto check = [&](double fraction, double expected) {
    double bias = 0;
    const DensityWindow window = maps.WindowAt({line.side, fraction * line.length});
    for (std::size_t r = 0; r < kReplicates; ++r) bias += maps.Bias(r, window, kAny)[0] / kReplicates;
    EXPECT_NEAR(bias * line.length / kEach, expected, 0.012) << fraction;
    EXPECT_NEAR(Mean(maps, window) * line.length / kEach, 3 * fraction * fraction + expected, 0.03) << fraction;
  };
  check(0.5, 0.04);   // h^2 / 3 * 3.
  check(1.0, -0.02);  // At an end the second moment is -1/6.
}

// Deeper photons are left out where they are not asked for.
TEST(PhotonMapsTest, BouncesAreCounted) {
  Line line;
  PhotonMaps::Photons photons;
  for (std::vector<Photon>& of : photons) {
    for (std::uint32_t depth = 0; depth < 4; ++depth)
      of.push_back({line.side, 0.5 * line.length, Spectrum::Grey(1 << (4 * depth)), depth});
  }
  DensityOptions options;
  options.kernel = Kernel::kBox;
  options.bandwidth = 0.25 * line.length;
  const PhotonMaps maps(line.stretches, std::move(photons), OnePath(), options, line.executor, 1);
  const DensityWindow window = maps.WindowAt({line.side, 0.5 * line.length});
  double sum = 0;
  for (std::uint32_t bounces = 0; bounces < 5; ++bounces) {
    if (bounces < 4) sum += 1 << (4 * bounces);
    EXPECT_NEAR(maps.Density(3, window, PhotonMaps::Width::kFirst, bounces)[0] * 0.5 * line.length, sum, 1e-9 * sum);
  }
}

// Wide where light is even, narrow beside an edge.
TEST(WidthChoiceTest, WidthsFollowTheLight) {
  Line line;
  DensityOptions options;
  constexpr std::size_t kEach = 2000;
  const auto bright_half = [&](double u) { return (u < 0.9 ? u / 1.8 : 0.5 + (u - 0.9) / 0.2) * line.length; };
  const PhotonMaps maps(line.stretches, Strewn(kEach, line.side, 5, bright_half), OnePath(), options, line.executor, 1);
  const auto ladder_at = [&](double fraction) {
    WidthLadder ladder;
    const SidePlace place{line.side, fraction * line.length};
    ladder.widest = maps.Widest(place);
    ladder.photon = 1.0 / kReplicates;
    double width = ladder.widest;
    for (int j = 0; j < 16; ++j, width /= WidthLadder::kRatio) {
      auto& densities = ladder.densities.emplace_back();
      for (std::size_t r = 0; r < kReplicates; ++r)
        densities[r] = maps.Density(r, maps.WindowOf(place, width), PhotonMaps::Width::kFirst, kAny)[0];
    }
    return ladder;
  };
  WidthChooser chooser;
  for (int i = 0; i < 40; ++i) chooser.Add(ladder_at((i + 0.5) / 40));
  const auto choose = [&](double fraction) {
    const WidthLadder ladder = ladder_at(fraction);
    return ladder.widest / std::pow(WidthLadder::kRatio, chooser.Choose(ladder).chosen) / line.length;
  };
  EXPECT_GT(choose(0.2), 0.1);
  EXPECT_GT(choose(0.8), 0.12);
  EXPECT_LT(choose(0.47), 0.03);
  EXPECT_LT(choose(0.53), 0.03);
}

}  // namespace
}  // namespace flatlight
