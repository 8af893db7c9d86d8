// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/analysis/point_summary.h"

#include <algorithm>
#include <cmath>

#include "client/cli/statistics/moments.h"

namespace flatlight {
namespace {

void SummariseTimes(const Runs& runs, PointSummary& point) {
  std::vector<double> cpu, wall;
  for (const BenchRow* run : runs) {
    cpu.push_back(run->cpu_seconds);
    wall.push_back(run->wall_seconds);
    point.rays += run->rays / static_cast<double>(runs.size());
  }
  point.cpu_least = *std::min_element(cpu.begin(), cpu.end());
  point.wall_least = *std::min_element(wall.begin(), wall.end());
  point.cpu_median = Median(cpu);
  point.wall_median = Median(wall);
}

double MeanOver(const std::vector<const QuantityError*>& errors, double (*value)(const QuantityError&)) {
  double sum = 0;
  for (const QuantityError* error : errors) sum += value(*error);
  return sum / static_cast<double>(errors.size());
}

void SummariseErrors(const std::vector<const QuantityError*>& errors, PointSummary& point) {
  const double square = MeanOver(errors, [](const QuantityError& e) { return e.rms * e.rms; });
  const double truth = MeanOver(errors, [](const QuantityError& e) { return e.truth_rms * e.truth_rms; });
  const double relative = std::sqrt(MeanOver(errors, [](const QuantityError& e) { return e.relative * e.relative; }));
  // The truth's own part is taken out of the mean of the squares, where it is unbiased.
  point.rms = std::sqrt(std::max(0.0, square - truth));
  if (square > 0) {
    point.relative = relative * point.rms / std::sqrt(square);
    point.truth_relative = relative * std::sqrt(truth / square);
  }
  std::vector<double> squares, z2;
  std::vector<std::vector<double>> sketches;
  for (const QuantityError* error : errors) {
    point.largest = std::max(point.largest, error->largest);
    squares.push_back(error->rms * error->rms);
    sketches.push_back(error->sketch);
    if (error->mean_z2) z2.push_back(*error->mean_z2);
  }
  const Moments scatter = MomentsOf(squares);
  // log(rms) = log(square) / 2.
  if (point.rms > 0)
    point.log_variance = scatter.variance / scatter.count / (4 * point.rms * point.rms * point.rms * point.rms);
  point.bias = EstimateBias(sketches, std::sqrt(truth));
  if (!z2.empty()) point.mean_z2 = MeanOf(MomentsOf(z2));
}

}  // namespace

std::optional<double> PointSummary::Efficiency() const {
  if (relative <= 0 || cpu_median <= 0) return std::nullopt;
  return 1 / (relative * relative * cpu_median);
}

Runs OneForEachSeed(const Runs& runs) {
  Runs chosen;
  for (const BenchRow* run : runs) {
    const auto same_seed = [run](const BenchRow* other) { return other->seed == run->seed; };
    if (std::none_of(chosen.begin(), chosen.end(), same_seed)) chosen.push_back(run);
  }
  return chosen;
}

std::optional<PointSummary> SummariseRuns(const Runs& runs, BenchQuantity quantity) {
  std::vector<const QuantityError*> errors;
  for (const BenchRow* run : OneForEachSeed(runs)) {
    if (!run->ErrorOf(quantity)) return std::nullopt;
    errors.push_back(&*run->ErrorOf(quantity));
  }
  PointSummary point;
  point.budget = runs[0]->budget;
  point.runs = static_cast<int>(runs.size());
  point.seeds = static_cast<int>(errors.size());
  SummariseTimes(runs, point);
  SummariseErrors(errors, point);
  return point;
}

}  // namespace flatlight
