// SPDX-License-Identifier: Apache-2.0
#include "core/statistics/replicates.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/check.h"
#include "core/statistics/shared_misses.h"

namespace flatlight {

double MeanEstimate::StandardError() const {
  const double spread = std::sqrt(variance * degrees_of_freedom / (degrees_of_freedom - 2) + unresolved * unresolved);
  return std::max(spread, kReplicateRounding * std::abs(mean) + rounding);
}

NearbyVariance NearbyVariances::Result() const {
  constexpr double kFewest = 4;
  if (count_ < kFewest) return {};
  const double mean_a = sum_a_ / count_, mean_b = sum_b_ / count_;
  const double common = std::max((products_ - count_ * mean_a * mean_b) / (count_ - 1), 0.0);
  const double noise = differences_ / (4 * count_);  // Of the average of a pair.
  if (!(noise > 0)) return {};
  return {(mean_a + mean_b) / 2, common / (common + noise)};
}

Spread SpreadOf(std::span<const double> values) {
  Spread spread;
  spread.count = static_cast<double>(values.size());
  double sum = 0;
  for (const double x : values) sum += x;
  spread.mean = sum / spread.count;
  for (const double x : values) spread.squares += (x - spread.mean) * (x - spread.mean);
  return spread;
}

Spread HalvesSpread::All() const {
  const double off = first.mean - second.mean;
  return {2 * first.count, (first.mean + second.mean) / 2,
          first.squares + second.squares + first.count * off * off / 2};
}

HalvesSpread HalvesSpreadOf(std::span<const double> values) {
  FLATLIGHT_DCHECK(values.size() % 2 == 0);
  return {SpreadOf(values.first(values.size() / 2)), SpreadOf(values.last(values.size() / 2))};
}

MeanEstimate EstimateMean(const Spread& spread, const Missable& missable, const NearbyVariance& nearby) {
  const double n = spread.count;
  const double squares = spread.squares;
  MeanEstimate estimate;
  estimate.mean = spread.mean;
  // What cannot miss anything is not like its neighbours.
  const double share = missable.largest > 0 ? nearby.share : 1;
  const double others = nearby.mean / n;
  estimate.variance = share * (squares / ((n - 1) * n)) + (1 - share) * others;
  constexpr double kLeastShare = 1e-3;
  estimate.degrees_of_freedom = (n - 1) / std::max(share, kLeastShare);
  if (Agree(squares, missable.Event())) {
    const double most = MostMissed(missable.largest, n);
    if (nearby.missed) {
      // Neighbours' variance is that of events which no value met here.
      estimate.variance = squares / ((n - 1) * n);
      estimate.degrees_of_freedom = n - 1;
      estimate.unresolved = std::min(std::sqrt(*nearby.missed), most);
      return estimate;
    }
    const double frequent = share < 1 ? std::min(missable.variance, others) : missable.variance;
    const double doubt = std::clamp(std::sqrt(frequent), missable.share * most, most);
    // What neighbours tell of the variance has the doubt in it.
    estimate.unresolved = share < 1 ? std::sqrt(std::max(doubt * doubt - estimate.variance, 0.0)) : doubt;
  }
  return estimate;
}

MeanEstimate Average(const MeanEstimate& a, const MeanEstimate& b) {
  MeanEstimate average;
  average.mean = (a.mean + b.mean) / 2;
  average.variance = (a.variance + b.variance) / 4;
  average.unresolved = std::sqrt(a.unresolved * a.unresolved + b.unresolved * b.unresolved) / 2;
  average.rounding = (a.rounding + b.rounding) / 2;
  const double sum = a.variance + b.variance;
  const double weights =
      a.variance * (a.variance / a.degrees_of_freedom) + b.variance * (b.variance / b.degrees_of_freedom);
  average.degrees_of_freedom = weights > 0 ? sum * (sum / weights) : a.degrees_of_freedom + b.degrees_of_freedom;
  return average;
}

double RelativeError(double mean, double standard_error, double floor) {
  if (standard_error == 0) return 0;
  const double size = std::max(mean, floor);
  return size > 0 ? standard_error / size : std::numeric_limits<double>::infinity();
}

}  // namespace flatlight
