// SPDX-License-Identifier: Apache-2.0
// Where a line meets one element. Distances are in units of the direction's length.
#ifndef FLATLIGHT_CORE_PLANE_INTERSECT_H_
#define FLATLIGHT_CORE_PLANE_INTERSECT_H_

#include "core/math/vec.h"
#include "core/scene/scene.h"

namespace flatlight {

// Up to two crossings, nearest first.
struct Crossings {
  int count = 0;
  double t[2] = {0, 0};
};

// All crossings of the line origin + t direction, t of any sign. Ends count as part of the element, to the distance
// `touch`; elements that share an end point, bit for bit, leave no gap between them.
Crossings CrossSegment(const Element& segment, Point2 origin, Vector2 direction, double touch);
Crossings CrossArc(const Element& arc, Point2 origin, Vector2 direction, double touch);

// For an origin on the arc's own circle: the one other crossing of the circle, if the arc is there.
Crossings CrossOwnCircle(const Element& arc, Point2 on_circle, Vector2 direction, double touch);

// The points that two elements have in common, overlaps aside.
struct ElementCrossings {
  int count = 0;
  Point2 point[2];
};
ElementCrossings CrossElements(const Element& e, const Element& f, double touch);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_INTERSECT_H_
