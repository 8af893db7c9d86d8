// SPDX-License-Identifier: Apache-2.0
// Error against time of one method in one scene: a point for each budget.
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_ANALYSIS_CURVE_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_ANALYSIS_CURVE_H_

#include <optional>
#include <string>
#include <vector>

#include "client/cli/bench/analysis/point_summary.h"
#include "client/cli/statistics/power_fit.h"

namespace flatlight {

struct Curve {
  std::string scene;
  std::string method;
  std::string settings;
  std::string truth;
  BenchQuantity quantity = BenchQuantity::kIrradiance;
  std::vector<PointSummary> points;      // By budget.
  std::optional<PowerFit> over_time;     // relative error over median processor time; only points with an error.
  std::optional<PowerFit> over_samples;  // The same over the budget.

  // All its points are free of error, but for the rounding of both methods.
  bool IsExact() const;
};

// Relative errors below are rounding.
inline constexpr double kRoundingError = 1e-9;

// A curve for each scene, method, settings, truth and quantity; scenes and methods by name, since the order of the rows
// depends on how long they took.
std::vector<Curve> CurvesOf(const std::vector<BenchRow>& rows);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_ANALYSIS_CURVE_H_
