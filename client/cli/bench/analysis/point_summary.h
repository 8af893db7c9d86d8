// SPDX-License-Identifier: Apache-2.0
// What the runs of one scene, method and budget say together.
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_ANALYSIS_POINT_SUMMARY_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_ANALYSIS_POINT_SUMMARY_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "client/cli/bench/measurement/sketch.h"
#include "client/cli/bench/rows/bench_row.h"
#include "client/cli/statistics/interval.h"

namespace flatlight {

// Runs that differ in repeat or seed alone.
using Runs = std::vector<const BenchRow*>;

struct PointSummary {
  std::optional<std::uint32_t> budget;
  int runs = 0;
  int seeds = 0;         // 1 for a method without.
  double cpu_least = 0;  // s
  double cpu_median = 0;
  double wall_least = 0;
  double wall_median = 0;
  double rays = 0;                   // Mean.
  double rms = 0;                    // Over seeds and points, without the truth's own error.
  double largest = 0;                // Of all runs.
  double relative = 0;               // rms over the RMS of the truth.
  double truth_relative = 0;         // The truth's own error in the same measure; 0 if it is exact.
  double log_variance = 0;           // Of log(relative), from the scatter between seeds; 0 if not known.
  std::optional<BiasEstimate> bias;  // In the unit of rms.
  std::optional<Estimate> mean_z2;   // Mean over the seeds.

  // 1 / (relative^2 * median processor time), 1/s: absent without error.
  std::optional<double> Efficiency() const;
};

// Absent if the runs do not have the quantity. `runs` is not empty.
std::optional<PointSummary> SummariseRuns(const Runs& runs, BenchQuantity quantity);

// One of the runs of each seed, in their order: repeats have the same error.
Runs OneForEachSeed(const Runs& runs);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_ANALYSIS_POINT_SUMMARY_H_
