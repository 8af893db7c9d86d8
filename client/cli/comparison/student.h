// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_COMPARISON_STUDENT_H_
#define FLATLIGHT_CLIENT_CLI_COMPARISON_STUDENT_H_

namespace flatlight {

// Degrees of freedom of a standard error: it comes from two halves of 8 independently randomised replicates.
inline constexpr int kDegreesOfFreedom = 14;

// P(|T| > t) for Student's t with kDegreesOfFreedom; Abramowitz & Stegun 26.7.4. t >= 0.
double StudentTail(double t);

// The t with StudentTail(t) = probability, which is in (0, 1].
double StudentQuantile(double probability);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMPARISON_STUDENT_H_
