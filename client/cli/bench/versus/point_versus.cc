// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/versus/point_versus.h"

#include <algorithm>
#include <cmath>

#include "client/cli/bench/analysis/curve.h"

namespace flatlight {
namespace {

// Errors that are rounding are all alike, so that they can be divided.
double LogError(const QuantityError& error) { return std::log(std::max(error.relative, kRoundingError)); }

std::optional<std::vector<double>> LogTimes(const Runs& runs) {
  std::vector<double> logs;
  for (const BenchRow* run : runs) {
    if (run->cpu_seconds <= 0) return std::nullopt;
    logs.push_back(std::log(run->cpu_seconds));
  }
  return logs;
}

// One run of each seed, by seed: those of A and B may have been done in another order.
Runs BySeed(const Runs& runs) {
  Runs chosen = OneForEachSeed(runs);
  std::sort(chosen.begin(), chosen.end(), [](const BenchRow* a, const BenchRow* b) { return a->seed < b->seed; });
  return chosen;
}

std::optional<std::vector<double>> LogErrors(const Runs& runs, BenchQuantity quantity) {
  std::vector<double> logs;
  for (const BenchRow* run : BySeed(runs)) {
    if (!run->ErrorOf(quantity)) return std::nullopt;
    logs.push_back(LogError(*run->ErrorOf(quantity)));
  }
  return logs;
}

bool SameSeeds(const Runs& a, const Runs& b) {
  const Runs seeds_a = BySeed(a), seeds_b = BySeed(b);
  return std::equal(seeds_a.begin(), seeds_a.end(), seeds_b.begin(), seeds_b.end(),
                    [](const BenchRow* x, const BenchRow* y) { return x->seed == y->seed; });
}

bool AllRounding(const std::vector<double>& logs) {
  const double rounding = std::log(kRoundingError);
  return std::all_of(logs.begin(), logs.end(), [rounding](double log) { return log <= rounding; });
}

bool Changed(const std::optional<Ratio>& ratio, Change change) { return ratio && ratio->change == change; }

}  // namespace

std::optional<Estimate> PointSamples::TimeRatio() const {
  return time ? std::optional<Estimate>(time->LogRatio()) : std::nullopt;
}

std::optional<Estimate> PointSamples::ErrorRatio() const {
  return error ? std::optional<Estimate>(error->LogRatio()) : std::nullopt;
}

std::optional<Estimate> PointSamples::Efficiency() const {
  return time && error ? std::optional<Estimate>(EfficiencyRatio(*ErrorRatio(), *TimeRatio())) : std::nullopt;
}

PointSamples SamplesOf(const Runs& a, const Runs& b, BenchQuantity quantity, bool times) {
  PointSamples samples;
  const auto times_a = LogTimes(a), times_b = LogTimes(b);
  if (times && times_a && times_b) samples.time = TimeSamples(*times_a, *times_b);
  const auto errors_a = LogErrors(a, quantity), errors_b = LogErrors(b, quantity);
  if (errors_a && errors_b && !(AllRounding(*errors_a) && AllRounding(*errors_b)))
    samples.error = LogSamples{*errors_a, *errors_b, a[0]->seed.has_value(), 1, SameSeeds(a, b)};
  return samples;
}

Change Together(const std::optional<Ratio>& time, const std::optional<Ratio>& error,
                const std::optional<Ratio>& efficiency) {
  for (const Change change : {Change::kBetter, Change::kWorse})
    if (Changed(efficiency, change)) return change;
  const bool worse = Changed(time, Change::kWorse) || Changed(error, Change::kWorse);
  const bool better = Changed(time, Change::kBetter) || Changed(error, Change::kBetter);
  if (worse != better) return worse ? Change::kWorse : Change::kBetter;
  if (worse) return efficiency && efficiency->change == Change::kNotSeen ? Change::kNotSeen : Change::kTooNoisy;
  const bool noisy = Changed(time, Change::kTooNoisy) || Changed(error, Change::kTooNoisy);
  return noisy ? Change::kTooNoisy : Change::kNotSeen;
}

}  // namespace flatlight
