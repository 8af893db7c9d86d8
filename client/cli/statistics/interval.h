// SPDX-License-Identifier: Apache-2.0
// Estimates with the noise they have, and intervals that hold the truth with a stated chance.
#ifndef FLATLIGHT_CLIENT_CLI_STATISTICS_INTERVAL_H_
#define FLATLIGHT_CLIENT_CLI_STATISTICS_INTERVAL_H_

#include "client/cli/statistics/moments.h"

namespace flatlight {

// A value whose deviation was itself estimated, with so many degrees of freedom; 0 degrees: nothing is known of it.
struct Estimate {
  double value = 0;
  double deviation = 0;  // Standard error.
  double degrees = 0;
};

// The mean of a sample.
Estimate MeanOf(const Moments& sample);

// b - a of independent estimates: B. L. Welch, Biometrika 34 (1947), 28.
Estimate Difference(const Estimate& a, const Estimate& b);

// Half the width of the interval around the value that misses the truth with this probability (Student). Infinite if
// nothing is known of the deviation.
double HalfWidth(const Estimate& estimate, double probability);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_STATISTICS_INTERVAL_H_
