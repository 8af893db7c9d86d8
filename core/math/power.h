// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_MATH_POWER_H_
#define FLATLIGHT_CORE_MATH_POWER_H_

namespace flatlight {

// The natural logarithm of a positive finite number, to 4e-16 of itself or of 1, whichever is more; the same bits on
// every machine.
double Log(double x);

// base^exponent for base in [0, 1] and exponent >= 0, to a relative error of 4e-16 (1 + |log of the result|). The same
// bits on every machine, which the C library's pow does not promise (+ - x / only).
double UnitPower(double base, double exponent);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_MATH_POWER_H_
