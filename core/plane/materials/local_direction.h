// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_MATERIALS_LOCAL_DIRECTION_H_
#define FLATLIGHT_CORE_PLANE_MATERIALS_LOCAL_DIRECTION_H_

namespace flatlight {

// A unit direction at a place of a curve, away from it: the sine of its angle from the normal toward the tangent
// (normal.y, -normal.x), and the cosine. The normal is that of the side on which light leaves: there cosines are
// positive, behind the curve negative.
struct LocalDirection {
  double sine = 0;
  double cosine = 1;
};

// Where a mirror would throw light that comes from `direction`.
inline LocalDirection Mirrored(LocalDirection direction) { return {-direction.sine, direction.cosine}; }

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_MATERIALS_LOCAL_DIRECTION_H_
