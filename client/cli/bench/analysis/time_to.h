// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_ANALYSIS_TIME_TO_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_ANALYSIS_TIME_TO_H_

#include <array>
#include <cstdint>

#include "client/cli/bench/analysis/curve.h"

namespace flatlight {

inline constexpr std::array<double, 3> kTargetErrors = {0.01, 0.001, 0.0001};

// Processor time until the relative error of a curve is so small.
struct TimeTo {
  enum class Source : std::uint8_t {
    kMeasured,      // Between two points that were measured, or at one of them.
    kAtMost,        // The fastest point is more accurate already.
    kExtrapolated,  // By the fit, beyond the most accurate point.
    kUnknown        // Nothing supports a figure.
  };
  Source source = Source::kUnknown;
  double seconds = 0;
};

// Extrapolates if the fit leaves no more than a factor of 2 of doubt, either way, at 95 %.
TimeTo TimeToError(const Curve& curve, double relative_error);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_ANALYSIS_TIME_TO_H_
