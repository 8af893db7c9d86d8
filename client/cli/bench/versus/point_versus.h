// SPDX-License-Identifier: Apache-2.0
// One point of a curve, in A and in B.
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_VERSUS_POINT_VERSUS_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_VERSUS_POINT_VERSUS_H_

#include <optional>

#include "client/cli/bench/analysis/point_summary.h"
#include "client/cli/bench/versus/ratio.h"

namespace flatlight {

// The samples of logarithms that are compared. Absent: there is nothing to compare.
struct PointSamples {
  std::optional<LogSamples> time;   // Of processor time.
  std::optional<LogSamples> error;  // Of the RMS error, a value a seed: repeats have the same.

  std::optional<Estimate> TimeRatio() const;
  std::optional<Estimate> ErrorRatio() const;
  std::optional<Estimate> Efficiency() const;  // If there are both.
};

// `runs` of both are of the same point, and not empty. Without `times`, those of different machines, only errors count.
PointSamples SamplesOf(const Runs& a, const Runs& b, BenchQuantity quantity, bool times);

// What the ratios say together: efficiency first, since a method may pay for one with the other; then time and error,
// where one that got worse and one that got better leave it open.
Change Together(const std::optional<Ratio>& time, const std::optional<Ratio>& error,
                const std::optional<Ratio>& efficiency);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_VERSUS_POINT_VERSUS_H_
