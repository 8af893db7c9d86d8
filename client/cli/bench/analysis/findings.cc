// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/analysis/findings.h"

#include <algorithm>

#include "client/cli/text/numbers.h"

namespace flatlight {
namespace {

constexpr double kFailureRate = 0.01;
constexpr double kRandomSlope = -0.5;  // Of independent samples.

std::string PlaceOf(const Curve& curve, const PointSummary* point) {
  std::string text = curve.scene + ' ' + curve.method;
  if (point != nullptr && point->budget) text += ' ' + std::to_string(*point->budget);
  if (curve.quantity != BenchQuantity::kIrradiance) text += std::string(", ") + NameOf(curve.quantity);
  return text + ": ";
}

void JudgePoint(const Curve& curve, const PointSummary& point, double rate, std::vector<std::string>& findings) {
  if (point.relative > kRoundingError && point.bias && point.bias->probability < rate)
    findings.push_back(PlaceOf(curve, &point) + "biased: the mean of " + Plural(point.seeds, "run") + " is off by " +
                       FormatValue(point.bias->rms, 3) + " RMS; noise alone gives " +
                       FormatValue(point.bias->noise_rms, 3));
  if (point.mean_z2 && point.mean_z2->value - HalfWidth(*point.mean_z2, rate) > 1)
    findings.push_back(PlaceOf(curve, &point) + "states its errors too small: mean z^2 is " +
                       FormatValue(point.mean_z2->value, 3) + ", honest errors give at most 1");
}

}  // namespace

std::vector<std::string> FindingsOf(const std::vector<Curve>& curves) {
  double tests = 0;
  for (const Curve& curve : curves) {
    for (const PointSummary& point : curve.points) tests += (point.bias ? 1 : 0) + (point.mean_z2 ? 1 : 0);
    tests += curve.over_time ? 1 : 0;
  }
  const double rate = kFailureRate / std::max(tests, 1.0);
  std::vector<std::string> findings;
  for (const Curve& curve : curves) {
    for (const PointSummary& point : curve.points) JudgePoint(curve, point, rate, findings);
    if (curve.over_time && curve.over_time->slope.value - HalfWidth(curve.over_time->slope, rate) > kRandomSlope)
      findings.push_back(PlaceOf(curve, nullptr) + "converges slower than by chance: the error falls as time to the " +
                         FormatValue(curve.over_time->slope.value, 3) + ", independent samples to the -0.5");
  }
  return findings;
}

}  // namespace flatlight
