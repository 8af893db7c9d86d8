// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_STATISTICS_CROSSED_HALVES_H_
#define FLATLIGHT_CORE_STATISTICS_CROSSED_HALVES_H_

#include <array>
#include <cstddef>
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
  // What error is small enough: standard error <= relative * max(mean, floor of the channel), and no single sample that
  // is as bright as `brightest` would move the mean by more than a fraction of that.
  struct Target {
    double relative = 0;
    std::vector<double> floor;      // One a channel.
    std::vector<double> brightest;  // One a channel.
  };
  using HalfEstimate = std::vector<MeanEstimate>;  // One a channel.

  // Where a whole probe is dark so far, no error is small beside it, and nothing is known of how rare bright samples
  // are: the point is given up for dark after this number of samples.
  static constexpr double kSamplesBeforeDarkness = 4096;
  // The error of a half that is good enough, in target errors. The average of two such halves has 1/sqrt(2) of it: what
  // is left is to spare, so that few points miss the target in the end.
  static constexpr double kHalfError = 1.25;
  // So many of the brightest samples, found or missed, make up the target error. With fewer the error would be judged
  // by a handful of them. (Measured: at 4 errors have the right size where at 0 the doubt in EstimateMean alone makes
  // them too large by a quarter; and for the same samples there is less error, as points go on that need it.)
  static constexpr double kBrightestInTarget = 4;

  // Offers both halves after `samples` samples of the whole point. targets[h] judges half h, and may depend on data of
  // that half only.
  void Offer(const std::array<HalfEstimate, 2>& halves, double samples, const std::array<Target, 2>& targets);

  bool decided() const { return decided_[0] && decided_[1]; }
  // The average of the halves: of the values they were decided with, or else of the current ones.
  MeanEstimate Estimate(const std::array<HalfEstimate, 2>& current, std::size_t channel) const;
  // Samples behind that estimate, if the current values have `current` samples.
  double Samples(double current) const;
  // Forgets the decisions; the next Offer brings later counts.
  void Reopen() { decided_ = {}; }

  // For a stream of states; `channels` estimates belong to each value.
  template <class Self, class Stream>
  static void State(Self& self, Stream& stream, std::size_t channels) {
    stream(self.decided_, self.samples_, self.values_);
    for (std::size_t half = 0; half < 2; ++half) {
      stream.Require(!self.decided_[half] || self.values_[half].size() == channels);
    }
  }

 private:
  std::array<bool, 2> decided_{};
  std::array<double, 2> samples_{};
  std::array<HalfEstimate, 2> values_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_STATISTICS_CROSSED_HALVES_H_
