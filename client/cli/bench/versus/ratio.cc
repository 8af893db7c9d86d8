// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/versus/ratio.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flatlight {
namespace {

std::vector<double> LeastOfNeighbours(const std::vector<double>& values, std::size_t size) {
  std::vector<double> least;
  for (std::size_t i = 0; i + size <= values.size(); i += size)
    least.push_back(*std::min_element(values.begin() + static_cast<std::ptrdiff_t>(i),
                                      values.begin() + static_cast<std::ptrdiff_t>(i + size)));
  return least;
}

Moments Ratios(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < a.size(); ++i) ratios.push_back(b[i] - a[i]);
  return MomentsOf(ratios);
}

}  // namespace

LogSamples TimeSamples(const std::vector<double>& log_times_a, const std::vector<double>& log_times_b) {
  // 2 of 8 runs, 4 of 32: both the number of groups and their size grow with that of runs.
  const auto runs = static_cast<double>(std::min(log_times_a.size(), log_times_b.size()));
  const auto size = std::max<std::size_t>(1, static_cast<std::size_t>(std::sqrt(runs / 2)));
  return {LeastOfNeighbours(log_times_a, size), LeastOfNeighbours(log_times_b, size), true, static_cast<int>(size),
          false};
}

Estimate LogSamples::LogRatio() const {
  Estimate ratio = Difference(MeanOf(MomentsOf(a)), MeanOf(MomentsOf(b)));
  if (pairs) ratio = MeanOf(Ratios(a, b));
  // What does not depend on chance has no deviation, however few the runs.
  return by_chance ? ratio : Estimate{ratio.value, 0, std::numeric_limits<double>::max()};
}

Estimate LogSamples::LogRatioOf(int size) const {
  const auto resized = [size](Moments moments) {
    moments.count = size;
    return MeanOf(moments);
  };
  return pairs ? resized(Ratios(a, b)) : Difference(resized(MomentsOf(a)), resized(MomentsOf(b)));
}

Ratio Judge(const Estimate& log_ratio, Good good, const RatioRule& rule) {
  const double half = HalfWidth(log_ratio, rule.probability);
  Ratio ratio{std::exp(log_ratio.value), std::exp(log_ratio.value - half), std::exp(log_ratio.value + half),
              Change::kNotSeen};
  const bool counts = std::abs(log_ratio.value) > std::log1p(rule.least);
  if (counts && std::abs(log_ratio.value) > half) {
    const bool less = log_ratio.value < 0;
    ratio.change = less == (good == Good::kLess) ? Change::kBetter : Change::kWorse;
  } else if (half > std::log1p(rule.Resolution())) {
    ratio.change = Change::kTooNoisy;
  }
  return ratio;
}

std::optional<int> RunsNeeded(const LogSamples& samples, const RatioRule& rule) {
  if (samples.a.size() < 2 || samples.b.size() < 2) return std::nullopt;
  constexpr int kMost = 1'000'000;
  const auto enough = [&](int runs) {
    return HalfWidth(samples.LogRatioOf(runs), rule.probability) <= std::log1p(rule.Resolution());
  };
  int low = 1, high = 2;
  for (; !enough(high); high *= 2) {
    if (high >= kMost) return std::nullopt;
    low = high;
  }
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (enough(middle) ? high : low) = middle;
  }
  return high * samples.runs_each;
}

Estimate EfficiencyRatio(const Estimate& log_error_ratio, const Estimate& log_time_ratio) {
  const Estimate minus_squares = {-2 * log_error_ratio.value, 2 * log_error_ratio.deviation, log_error_ratio.degrees};
  return Difference(log_time_ratio, minus_squares);
}

}  // namespace flatlight
