// SPDX-License-Identifier: Apache-2.0
// A power law y = c x^slope through measured points: a straight line in logarithms.
#ifndef FLATLIGHT_CLIENT_CLI_STATISTICS_POWER_FIT_H_
#define FLATLIGHT_CLIENT_CLI_STATISTICS_POWER_FIT_H_

#include <optional>
#include <vector>

#include "client/cli/statistics/interval.h"

namespace flatlight {

struct LogPoint {
  double log_x = 0;
  double log_y = 0;
  double variance = 0;  // Of log_y; 0 if not known. Only the ratios count.
};

// Least squares, each point weighed by 1 / variance (all alike if one of them is not known). The scatter of the points
// around the line, not their own variance, says how sure it is: so a bend of the points counts as doubt.
struct PowerFit {
  Estimate slope;       // Degrees of freedom: points - 2.
  double centre_x = 0;  // Weighted means: slope and level there are independent.
  double centre_y = 0;
  double level_deviation = 0;  // Standard error of the line at centre_x.

  // log_y of the line, with its standard error.
  Estimate At(double log_x) const;
  // The log_x at which the line reaches log_y; its deviation is that of the line there over the slope.
  Estimate Reaches(double log_y) const;
};

// Absent for fewer than 3 points, or if all have the same x.
std::optional<PowerFit> FitPower(const std::vector<LogPoint>& points);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_STATISTICS_POWER_FIT_H_
