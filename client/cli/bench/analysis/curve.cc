// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/analysis/curve.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace flatlight {
namespace {

bool SameCurve(const BenchRow& a, const BenchRow& b) {
  return std::tie(a.scene_hash, a.method, a.settings, a.truth) == std::tie(b.scene_hash, b.method, b.settings, b.truth);
}

// Groups of rows for which `same` holds, each in the order of its first row.
template <class Same>
std::vector<Runs> Grouped(const Runs& rows, Same same) {
  std::vector<Runs> groups;
  for (const BenchRow* row : rows) {
    const auto group =
        std::find_if(groups.begin(), groups.end(), [&](const Runs& runs) { return same(*runs[0], *row); });
    (group == groups.end() ? groups.emplace_back() : *group).push_back(row);
  }
  return groups;
}

void Fit(Curve& curve) {
  std::vector<LogPoint> time, samples;
  for (const PointSummary& point : curve.points) {
    if (point.relative <= kRoundingError || point.cpu_median <= 0) continue;
    const double error = std::log(point.relative);
    time.push_back({std::log(point.cpu_median), error, point.log_variance});
    if (point.budget) samples.push_back({std::log(*point.budget), error, point.log_variance});
  }
  curve.over_time = FitPower(time);
  curve.over_samples = FitPower(samples);
}

}  // namespace

bool Curve::IsExact() const {
  return std::all_of(points.begin(), points.end(), [](const PointSummary& p) { return p.relative <= kRoundingError; });
}

std::vector<Curve> CurvesOf(const std::vector<BenchRow>& rows) {
  Runs all;
  for (const BenchRow& row : rows) all.push_back(&row);
  std::stable_sort(all.begin(), all.end(), [](const BenchRow* a, const BenchRow* b) {
    return std::tie(a->scene, a->method) < std::tie(b->scene, b->method);
  });
  std::vector<Curve> curves;
  for (const Runs& runs : Grouped(all, SameCurve)) {
    std::vector<Runs> points = Grouped(runs, SamePoint);
    std::sort(points.begin(), points.end(), [](const Runs& a, const Runs& b) { return a[0]->budget < b[0]->budget; });
    for (const BenchQuantity quantity : kBenchQuantities) {
      Curve curve{runs[0]->scene, runs[0]->method, runs[0]->settings, runs[0]->truth, quantity, {}, {}, {}};
      for (const Runs& point : points)
        if (const auto summary = SummariseRuns(point, quantity)) curve.points.push_back(*summary);
      if (curve.points.empty()) continue;
      Fit(curve);
      curves.push_back(std::move(curve));
    }
  }
  return curves;
}

}  // namespace flatlight
