// SPDX-License-Identifier: Apache-2.0
#include "client/cli/statistics/power_fit.h"

#include <algorithm>
#include <cmath>

namespace flatlight {

Estimate PowerFit::At(double log_x) const {
  const double off = log_x - centre_x;
  return {centre_y + slope.value * off, std::hypot(level_deviation, slope.deviation * off), slope.degrees};
}

Estimate PowerFit::Reaches(double log_y) const {
  const double log_x = centre_x + (log_y - centre_y) / slope.value;
  return {log_x, At(log_x).deviation / std::abs(slope.value), slope.degrees};
}

std::optional<PowerFit> FitPower(const std::vector<LogPoint>& points) {
  if (points.size() < 3) return std::nullopt;
  const bool weighed = std::all_of(points.begin(), points.end(), [](const LogPoint& p) { return p.variance > 0; });
  const auto weight = [weighed](const LogPoint& p) { return weighed ? 1 / p.variance : 1.0; };
  PowerFit fit;
  double sum = 0;
  for (const LogPoint& p : points) {
    sum += weight(p);
    fit.centre_x += weight(p) * p.log_x;
    fit.centre_y += weight(p) * p.log_y;
  }
  fit.centre_x /= sum;
  fit.centre_y /= sum;
  double xx = 0, xy = 0;
  for (const LogPoint& p : points) {
    xx += weight(p) * (p.log_x - fit.centre_x) * (p.log_x - fit.centre_x);
    xy += weight(p) * (p.log_x - fit.centre_x) * (p.log_y - fit.centre_y);
  }
  if (!(xx > 0)) return std::nullopt;
  fit.slope.value = xy / xx;
  fit.slope.degrees = static_cast<double>(points.size()) - 2;
  double scatter = 0;
  for (const LogPoint& p : points) {
    const double off = p.log_y - fit.At(p.log_x).value;
    scatter += weight(p) * off * off / fit.slope.degrees;
  }
  fit.slope.deviation = std::sqrt(scatter / xx);
  fit.level_deviation = std::sqrt(scatter / sum);
  return fit;
}

}  // namespace flatlight
