// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_MATH_TRIG_H_
#define FLATLIGHT_CORE_MATH_TRIG_H_

namespace flatlight {

struct SinCosValue {
  double sin = 0;
  double cos = 1;
};

// Sine and cosine of an angle in radians, |angle| <= 2e6, to 2 units in the last place. The C library picks its code by
// processor; this gives the same bits on every machine (it uses + - x only).
// Method: reduction by multiples of pi/2 held in three parts (Cody and Waite 1980), then Taylor polynomials.
SinCosValue SinCos(double angle);

// The angle in [0, pi] whose cosine and sine are to each other as x and y, y >= 0, not both 0; to 8e-16 of itself.
double AngleOf(double x, double y);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_MATH_TRIG_H_
