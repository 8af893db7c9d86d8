// SPDX-License-Identifier: Apache-2.0
#include "core/plane/photon_mapping/width_choice.h"

#include <algorithm>
#include <cmath>

namespace flatlight {
namespace {

// The share of variance in what is made least, and of the expected bias in what is stated. Measured from 1 to 4 and
// from 1 on: these had about the least errors over numbers of photons and scenes of the gallery, and a mean square of
// what the stated bias leaves, over standard errors, of about 1 (./run bench photon_mapping).
constexpr double kWeight = 2;
constexpr double kStated = 1.2;
// Where so many replicates have photons in reach, their spread tells the noise.
constexpr std::ptrdiff_t kFewestReplicates = 12;
// Where so many photons would be in reach if a wider kernel were right, their absence says that it is not.
constexpr double kExpectedPhotons = 16;

using Densities = std::array<double, kReplicates>;

double Mean(const Densities& densities) {
  double sum = 0;
  for (const double density : densities) sum += density;
  return sum / kReplicates;
}

// The difference of two means, and its variance.
struct Difference {
  double mean = 0;
  double variance = 0;
};

Difference Between(const Densities& a, const Densities& b) {
  Difference difference{Mean(a) - Mean(b)};
  for (std::size_t r = 0; r < kReplicates; ++r) {
    const double d = a[r] - b[r] - difference.mean;
    difference.variance += d * d / (kReplicates * (kReplicates - 1));
  }
  return difference;
}

}  // namespace

void WidthChooser::Add(const WidthLadder& ladder) {
  beyond_noise_.resize(ladder.densities.size());
  for (std::size_t j = 0; j < beyond_noise_.size(); ++j) {
    for (std::size_t i = j + 1; i < std::min(beyond_noise_.size(), j + 1 + kReach); ++i) {
      const Difference difference = Between(ladder.densities[j], ladder.densities[i]);
      beyond_noise_[j][i - j - 1] += difference.mean * difference.mean - difference.variance;
    }
  }
  ++places_;
}

WidthChoice WidthChooser::Choose(const WidthLadder& ladder) const {
  const std::size_t count = ladder.densities.size();
  // Mean squares of the bias at all places.
  std::vector<double> expected(count);
  for (std::size_t j = 0; j < count; ++j)
    for (const double sum : beyond_noise_[j]) expected[j] = std::max(expected[j], sum / places_);
  WidthChoice choice;
  double least = 0, wider_mean = 0;
  double width = ladder.widest;
  for (std::size_t j = 0; j < count; ++j, width /= WidthLadder::kRatio) {
    const Densities& densities = ladder.densities[j];
    const auto filled = std::count_if(densities.begin(), densities.end(), [](double d) { return d != 0; });
    // Less than none, at an end, is as wrong as too much.
    const bool missed = std::abs(wider_mean) * 2 * width >= kExpectedPhotons * ladder.photon;
    if (j > 0 && filled < kFewestReplicates && !missed) break;
    // Mean squares of the bias, given what each narrower width tells of this place.
    double found = 0, stated = 0, widths = 0;
    for (std::size_t i = j + 1; expected[j] > 0 && i < std::min(count, j + 1 + kReach); ++i) {
      const Difference difference = Between(densities, ladder.densities[i]);
      const auto given = [&](double noise) {
        const double share = expected[j] / (expected[j] + noise);
        return share * difference.mean * (share * difference.mean) + share * noise;
      };
      // What the narrower one is off by itself would hide that this place is like few others; but it is a doubt.
      found = std::max(found, given(difference.variance));
      stated += given(difference.variance + expected[i]);
      ++widths;
    }
    const MeanEstimate estimate =
        EstimateMean(densities, static_cast<double>(kReplicates) * ladder.photon / (2 * width));
    wider_mean = estimate.mean;
    const double cost = found + kWeight * estimate.StandardError() * estimate.StandardError();
    if (j > 0 && cost >= least) continue;
    least = cost;
    choice = {j, widths > 0 ? kStated * std::sqrt(stated / widths) : 0};
  }
  return choice;
}

}  // namespace flatlight
