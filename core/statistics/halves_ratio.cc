// SPDX-License-Identifier: Apache-2.0
#include "core/statistics/halves_ratio.h"

#include <cstddef>

#include "core/math/check.h"

namespace flatlight {

MeanEstimate VarianceRatio::Of(MeanEstimate estimate) const {
  estimate.variance *= ratio;
  // Relative variances of factors add up.
  estimate.degrees_of_freedom = 1 / (1 / estimate.degrees_of_freedom + 1 / degrees_of_freedom);
  return estimate;
}

double HalvesRatios::SquaredError(std::span<const double> values) {
  FLATLIGHT_DCHECK(values.size() >= 2 && values.size() % 2 == 0);
  const std::size_t half = values.size() / 2;
  double difference = 0;
  for (std::size_t i = 0; i < half; ++i) difference += values[i] - values[half + i];
  const double off = difference / static_cast<double>(values.size());  // Half of what the means differ by.
  return off * off;
}

VarianceRatio HalvesRatios::Result() const {
  if (points_ == 0) return {};
  // Eight points' worth of 1 beside one point, less than one beside sixty: there it would show in small ratios.
  const double prior = 64 / (8 + points_);
  return {(prior + sum_) / (prior + points_), (prior + points_) * (prior + points_) / points_};
}

}  // namespace flatlight
