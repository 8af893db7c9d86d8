// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/analysis/time_to.h"

#include <cmath>

namespace flatlight {
namespace {

constexpr double kDoubt = 0.05;
const double kLargestDoubt = std::log(2);

// On the line between two points of a log-log plot.
double Interpolated(const PointSummary& worse, const PointSummary& better, double error) {
  // A better point without any error is there at once.
  if (better.relative <= 0) return better.cpu_median;
  const double part = std::log(error / worse.relative) / std::log(better.relative / worse.relative);
  return worse.cpu_median * std::pow(better.cpu_median / worse.cpu_median, part);
}

}  // namespace

TimeTo TimeToError(const Curve& curve, double relative_error) {
  using Source = TimeTo::Source;
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    if (curve.points[i].relative > relative_error) continue;
    // A method without budgets takes what it takes.
    if (i == 0) return {curve.points[0].budget ? Source::kAtMost : Source::kMeasured, curve.points[0].cpu_median};
    return {Source::kMeasured, Interpolated(curve.points[i - 1], curve.points[i], relative_error)};
  }
  if (!curve.over_time || curve.over_time->slope.value >= 0) return {};
  const PowerFit& fit = *curve.over_time;
  if (fit.slope.value + HalfWidth(fit.slope, kDoubt) >= 0) return {};
  const Estimate reached = fit.Reaches(std::log(relative_error));
  if (HalfWidth(reached, kDoubt) > kLargestDoubt) return {};
  return {Source::kExtrapolated, std::exp(reached.value)};
}

}  // namespace flatlight
