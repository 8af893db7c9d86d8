// SPDX-License-Identifier: Apache-2.0
// How well the place is known where two curves meet.
#ifndef FLATLIGHT_CORE_PLANE_EXACT_MEETING_H_
#define FLATLIGHT_CORE_PLANE_EXACT_MEETING_H_

#include "core/plane/exact/edge.h"
#include "core/scene/scene.h"

namespace flatlight {

// Adds to an edge the error of the place where two elements cross or touch there: a shift by d of one of them moves it
// by d over the sine of the angle between them, but by no more than what takes curves of other curvature d apart.
void AddMeetingError(const Scene& scene, const Receiver& receiver, const Element& e, const Element& f, Edge& edge);

// Whether the true direction of an edge with such errors may be between two keys.
bool MayLieBetween(const Edge& edge, double low, double high);

// Places where two elements come so close side by side that their coordinates don't tell whether they cross: at most
// two.
struct Tangencies {
  int count = 0;
  Point2 place[2];
};
Tangencies FindTangencies(const Scene& scene, const Element& e, const Element& f);

// Whether both follow one Bézier where it bends to one side, or one after the other: they meet at the end that they
// share, if any, and nowhere else.
bool FollowOneBend(const Scene& scene, const Element& e, const Element& f);

// Whether they have an end in common, bit by bit, at a point: then the place is that of the end.
bool ShareEnd(const Element& e, const Element& f, Point2 point);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_EXACT_MEETING_H_
