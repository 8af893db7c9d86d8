// SPDX-License-Identifier: Apache-2.0
// On which side things lie, decided for the coordinates as they are. Coordinates are 0 or of sizes in [2^-450, 2^10].
#ifndef FLATLIGHT_CORE_PLANE_TRIANGULATION_PREDICATES_H_
#define FLATLIGHT_CORE_PLANE_TRIANGULATION_PREDICATES_H_

#include "core/math/vec.h"

namespace flatlight {

// +1 if a, b, c turn counter-clockwise, -1 if clockwise, 0 if they lie on one line: exact.
int Orientation(Point2 a, Point2 b, Point2 c);

// Whether d lies inside the circle through a, b, c (counter-clockwise) beyond doubt. False where rounding hides it:
// what rests on it is as good a triangulation as can be told, not a right or a wrong one.
bool IsInsideCircle(Point2 a, Point2 b, Point2 c, Point2 d);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_TRIANGULATION_PREDICATES_H_
