// SPDX-License-Identifier: Apache-2.0
#include "client/cli/statistics/moments.h"

#include <algorithm>

namespace flatlight {

Moments MomentsOf(const std::vector<double>& values) {
  Moments moments;
  double squares = 0;
  for (const double value : values) {  // B. P. Welford, Technometrics 4 (1962), 419.
    const double off = value - moments.mean;
    moments.mean += off / ++moments.count;
    squares += off * (value - moments.mean);
  }
  if (moments.count > 1) moments.variance = squares / (moments.count - 1);
  return moments;
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

}  // namespace flatlight
