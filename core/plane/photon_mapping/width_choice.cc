// SPDX-License-Identifier: Apache-2.0
#include "core/plane/photon_mapping/width_choice.h"

#include <algorithm>
#include <cmath>

namespace flatlight {
namespace {

// How many times the variance a square difference must be above to be more than noise, the share of variance in what is
// made least, and how many narrower widths a width is held against: more of them are mostly noise. Measured: from 6, 1
// and 15 on, these had the least errors over numbers of photons and scenes of the gallery (./run bench photon_mapping).
constexpr double kNoise = 14;
constexpr double kWeight = 2;
constexpr std::size_t kReach = 5;
// Where so many replicates have photons in reach, their spread tells the noise.
constexpr std::ptrdiff_t kFewestReplicates = 12;
// Where so many photons would be in reach if a wider kernel were right, their absence says that it is not.
constexpr double kExpectedPhotons = 16;

}  // namespace

WidthChoice ChooseWidth(const WidthLadder& ladder) {
  const std::size_t count = ladder.densities.size();
  std::vector<double> mean(count), variance(count);
  std::size_t usable = 0;
  for (double width = ladder.widest; usable < count; ++usable, width /= WidthLadder::kRatio) {
    const auto& densities = ladder.densities[usable];
    const auto filled = std::count_if(densities.begin(), densities.end(), [](double d) { return d != 0; });
    // Less than none, at an end, is as wrong as too much.
    const bool expected = usable > 0 && std::abs(mean[usable - 1]) * 2 * width >= kExpectedPhotons * ladder.photon;
    if (usable > 0 && filled < kFewestReplicates && !expected) break;
    const double step = static_cast<double>(kReplicates) * ladder.photon / (2 * width);
    const MeanEstimate estimate = EstimateMean(densities, step);
    mean[usable] = estimate.mean;
    variance[usable] = estimate.StandardError() * estimate.StandardError();
  }
  // Of the difference of two means.
  const auto variance_between = [&](std::size_t i, std::size_t j) {
    double squares = 0;
    for (std::size_t r = 0; r < kReplicates; ++r) {
      const double d = ladder.densities[i][r] - ladder.densities[j][r] - (mean[i] - mean[j]);
      squares += d * d;
    }
    return squares / (kReplicates * (kReplicates - 1));
  };
  WidthChoice choice;
  double least = 0;
  for (std::size_t j = 0; j < usable; ++j) {
    double bias = 0;
    for (std::size_t i = j + 1; i < std::min(usable, j + 1 + kReach); ++i) {
      const double difference = mean[j] - mean[i];
      bias = std::max(bias, difference * difference - kNoise * variance_between(i, j));
    }
    const double cost = bias + kWeight * variance[j];
    if (j > 0 && cost >= least) continue;
    least = cost;
    choice.chosen = j;
    choice.bias = std::sqrt(bias);
  }
  // What differs less than that shows between neighbouring widths: bias goes by the square of the width, or slower.
  const double ratio = WidthLadder::kRatio * WidthLadder::kRatio * WidthLadder::kRatio * WidthLadder::kRatio;
  const std::size_t wider = choice.chosen - 2, narrower = choice.chosen + 2;
  if (choice.chosen >= 2)
    choice.bias = std::max(choice.bias, std::abs(mean[wider] - mean[choice.chosen]) / (ratio - 1));
  if (narrower < usable) {
    const double difference = mean[narrower] - mean[choice.chosen];
    const double beyond = difference * difference - variance_between(narrower, choice.chosen);
    choice.bias = std::max(choice.bias, std::sqrt(std::max(beyond, 0.0)) / (1 - 1 / ratio));
  }
  return choice;
}

}  // namespace flatlight
