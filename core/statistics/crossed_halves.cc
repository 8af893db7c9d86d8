// SPDX-License-Identifier: Apache-2.0
#include "core/statistics/crossed_halves.h"

#include <algorithm>

namespace flatlight {
namespace {

// The means of one half, estimated channel by channel.
std::vector<MeanEstimate> HalfEstimates(std::span<const double> replicate_means, std::size_t half) {
  std::vector<MeanEstimate> estimates;
  for (std::size_t first = half * kHalfReplicates; first < replicate_means.size(); first += kReplicates) {
    estimates.push_back(EstimateMean(replicate_means.subspan(first, kHalfReplicates)));
  }
  return estimates;
}

bool GoodEnough(const std::vector<MeanEstimate>& estimates, double samples, const CrossedHalves::Target& target) {
  const bool dark = std::all_of(estimates.begin(), estimates.end(),
                                [](const MeanEstimate& e) { return e.mean == 0 && e.variance == 0; });
  if (dark) return samples >= CrossedHalves::kSamplesBeforeDarkness;
  for (std::size_t c = 0; c < estimates.size(); ++c) {
    const double error = estimates[c].StandardError();
    if (!(error <= target.relative * std::max(estimates[c].mean, target.floor[c]))) return false;
  }
  return true;
}

}  // namespace

void CrossedHalves::Offer(std::span<const double> replicate_means, double samples,
                          const std::array<Target, 2>& targets) {
  std::array<std::vector<MeanEstimate>, 2> halves = {HalfEstimates(replicate_means, 0),
                                                     HalfEstimates(replicate_means, 1)};
  for (std::size_t half = 0; half < 2; ++half) {
    const std::size_t other = 1 - half;
    if (decided_[half] || !GoodEnough(halves[other], samples, targets[other])) continue;
    decided_[half] = true;
    samples_[half] = samples;
    values_[half] = halves[half];
  }
}

MeanEstimate CrossedHalves::Estimate(std::size_t channel) const {
  return Average(values_[0][channel], values_[1][channel]);
}

}  // namespace flatlight
