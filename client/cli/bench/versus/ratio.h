// SPDX-License-Identifier: Apache-2.0
// A figure of B over that of A, and whether it tells a change from noise.
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_VERSUS_RATIO_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_VERSUS_RATIO_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "client/cli/statistics/interval.h"

namespace flatlight {

enum class Change : std::uint8_t { kNotSeen, kBetter, kWorse, kTooNoisy };
enum class Good : std::uint8_t { kLess, kMore };  // Time and error; efficiency.

// Two samples of logarithms.
struct LogSamples {
  std::vector<double> a, b;
  bool by_chance = true;  // False: a run gives the same every time, so that one tells all.
  int runs_each = 1;      // Runs behind a value.
  bool pairs = false;  // a[i] and b[i] are of the same seed: the ratios count, which may scatter less, or not at all.

  Estimate LogRatio() const;            // Of the means.
  Estimate LogRatioOf(int size) const;  // With the deviation that so many values each would give.
};

// Processor times of runs in their order, as logarithms: the least of every few neighbours, as many for A as for B.
// Other work on a machine makes runs slower, never faster, and does so for a while: the least time of neighbours is
// nearly free of it, and what is left shows in the scatter. J. Chen, J. Revels, "Robust benchmarking in noisy
// environments", 2016.
LogSamples TimeSamples(const std::vector<double>& log_times_a, const std::vector<double>& log_times_b);

struct RatioRule {
  double probability = 0.01;                       // That an interval misses the true ratio.
  double least = 0.05;                             // The smallest relative change that counts.
  double Resolution() const { return 4 * least; }  // A wider interval is too noisy.
};

struct Ratio {
  double value = 1;
  double low = 1;  // The interval; 0 and infinity if the noise is not known.
  double high = 1;
  Change change = Change::kNotSeen;
};

// A change is seen if the interval leaves 1 out and the ratio differs by what counts. Else the interval decides: up to
// the resolution to either side there is no difference, a wider one is too noisy.
Ratio Judge(const Estimate& log_ratio, Good good, const RatioRule& rule);

// That of 1 / (error^2 * time).
Estimate EfficiencyRatio(const Estimate& log_error_ratio, const Estimate& log_time_ratio);

// How many runs each of A and B would need for an interval within the resolution, scattering as these do. Absent for
// samples of which nothing is known, or if even a million would not do.
std::optional<int> RunsNeeded(const LogSamples& samples, const RatioRule& rule);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_VERSUS_RATIO_H_
