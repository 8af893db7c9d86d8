// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_STATISTICS_CROSSED_HALVES_H_
#define FLATLIGHT_CORE_STATISTICS_CROSSED_HALVES_H_

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/statistics/replicates.h"

namespace flatlight {

// When to stop sampling one quantity (of one or more channels) without biasing it. Stopping where a sample's own error
// looks small keeps samples that miss rare bright paths; so the replicates form two halves, and each half's number of
// samples is decided by the statistics of the other, of which it is independent. The estimate is the plain average of
// the halves. (THEORY 18 B12, remedy 1.)
//
// Both halves are offered at the same counts. A half that is decided keeps the value it had then.
class CrossedHalves {
 public:
  // What error is small enough: standard error <= relative * max(mean, floor of the channel).
  struct Target {
    double relative = 0;
    std::vector<double> floor;  // One a channel.
  };

  // A half without a single bright sample says nothing about how rare those are: it doesn't decide before this number
  // of samples of the whole point.
  static constexpr double kSamplesBeforeDarkness = 4096;

  // Offers the means of all replicates (channel after channel, kReplicates each) after `samples` samples of the whole
  // point. targets[h] judges half h, and may depend on data of that half only.
  void Offer(std::span<const double> replicate_means, double samples, const std::array<Target, 2>& targets);

  bool decided() const { return decided_[0] && decided_[1]; }
  // Of the values the estimate uses. Requires decided().
  double samples() const { return (samples_[0] + samples_[1]) / 2; }
  MeanEstimate Estimate(std::size_t channel) const;
  // Forgets the decisions; the next Offer brings later counts.
  void Reopen() { decided_ = {}; }

 private:
  std::array<bool, 2> decided_{};
  std::array<double, 2> samples_{};
  std::array<std::vector<MeanEstimate>, 2> values_;  // By half, then channel.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_STATISTICS_CROSSED_HALVES_H_
