// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_STATISTICS_MOMENTS_H_
#define FLATLIGHT_CLIENT_CLI_STATISTICS_MOMENTS_H_

#include <vector>

namespace flatlight {

// Of a sample; `variance` is the unbiased one of a single value, 0 if there is but one.
struct Moments {
  int count = 0;
  double mean = 0;
  double variance = 0;
};

Moments MomentsOf(const std::vector<double>& values);

// The middle one, or the mean of the two in the middle. `values` is not empty.
double Median(std::vector<double> values);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_STATISTICS_MOMENTS_H_
