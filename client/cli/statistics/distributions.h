// SPDX-License-Identifier: Apache-2.0
// Tails and quantiles of the distributions that verdicts rest on. Degrees of freedom are above 0 and need not be whole.
#ifndef FLATLIGHT_CLIENT_CLI_STATISTICS_DISTRIBUTIONS_H_
#define FLATLIGHT_CLIENT_CLI_STATISTICS_DISTRIBUTIONS_H_

namespace flatlight {

// P(|T| > t) for Student's t. t >= 0.
double StudentTail(double t, double degrees);

// The t with StudentTail(t, degrees) = probability, which is in (0, 1].
double StudentQuantile(double probability, double degrees);

// P(F > f) for the ratio of two mean squares (Fisher, Snedecor). f >= 0.
double FisherTail(double f, double numerator_degrees, double denominator_degrees);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_STATISTICS_DISTRIBUTIONS_H_
