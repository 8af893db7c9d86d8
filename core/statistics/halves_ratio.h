// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_STATISTICS_HALVES_RATIO_H_
#define FLATLIGHT_CORE_STATISTICS_HALVES_RATIO_H_

#include <limits>
#include <optional>
#include <span>

#include "core/statistics/replicates.h"

namespace flatlight {

// The variance of a mean over what the spread of its replicates would have it be.
struct VarianceRatio {
  double ratio = 1;
  double degrees_of_freedom = std::numeric_limits<double>::infinity();

  // An estimate that took its variance from the spread, with the variance that it has.
  MeanEstimate Of(MeanEstimate estimate) const;
};

// Replicates of one half share a sequence, and where that places an edge more sharply than each of them does, their
// mean is off by less than their spread tells: with one edge, by an eighth in variance. The halves are independent, so
// what their means differ by tells the truth, but with one degree of freedom. It takes many points.
class HalvesRatios {
 public:
  // The mean of all values of a point, an even number, has the squared error that this has as its expectation.
  static double SquaredError(std::span<const double> values);

  // A point: its SquaredError, and the variance that spreads tell of the mean. Nothing is to be learnt from a variance
  // of 0 or of rounding.
  void Add(double squared_error, double variance) { ++points_, sum_ += squared_error / variance; }
  void Add(const HalvesRatios& other) { points_ += other.points_, sum_ += other.sum_; }
  // Draws the mean of few points towards 1.
  VarianceRatio Result() const;

 private:
  double points_ = 0, sum_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_STATISTICS_HALVES_RATIO_H_
