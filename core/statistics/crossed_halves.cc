// SPDX-License-Identifier: Apache-2.0
#include "core/statistics/crossed_halves.h"

#include <algorithm>

namespace flatlight {
namespace {

bool GoodEnough(const CrossedHalves::HalfEstimate& estimates, double samples, const CrossedHalves::Target& target) {
  bool dark = true;
  for (std::size_t c = 0; c < estimates.size(); ++c) dark = dark && estimates[c].mean == 0 && target.floor[c] == 0;
  if (dark) return samples >= CrossedHalves::kSamplesBeforeDarkness;
  for (std::size_t c = 0; c < estimates.size(); ++c) {
    const double allowed = target.relative * std::max(estimates[c].mean, target.floor[c]);
    if (!(estimates[c].StandardError() <= CrossedHalves::kHalfError * allowed)) return false;
    if (!(CrossedHalves::kBrightestInTarget * target.brightest[c] <= samples * allowed)) return false;
  }
  return true;
}

}  // namespace

void CrossedHalves::Offer(const std::array<HalfEstimate, 2>& halves, double samples,
                          const std::array<Target, 2>& targets) {
  for (std::size_t half = 0; half < 2; ++half) {
    const std::size_t other = 1 - half;
    if (decided_[half] || !GoodEnough(halves[other], samples, targets[other])) continue;
    decided_[half] = true;
    samples_[half] = samples;
    values_[half] = halves[half];
  }
}

MeanEstimate CrossedHalves::Estimate(const std::array<HalfEstimate, 2>& current, std::size_t channel) const {
  return Average((decided_[0] ? values_ : current)[0][channel], (decided_[1] ? values_ : current)[1][channel]);
}

double CrossedHalves::Samples(double current) const {
  return ((decided_[0] ? samples_[0] : current) + (decided_[1] ? samples_[1] : current)) / 2;
}

}  // namespace flatlight
