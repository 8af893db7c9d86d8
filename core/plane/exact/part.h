// SPDX-License-Identifier: Apache-2.0
// What a receiver sees of one element, were nothing else there.
#ifndef FLATLIGHT_CORE_PLANE_EXACT_PART_H_
#define FLATLIGHT_CORE_PLANE_EXACT_PART_H_

#include "core/math/vec.h"
#include "core/plane/exact/edge.h"
#include "core/scene/scene.h"

namespace flatlight {

// A stretch of an element, above the horizon, that each direction meets at most once.
struct Part {
  enum class Kind : unsigned char {
    kStraight,
    kConvex,   // An arc seen from outside its circle, the side that bulges toward the receiver.
    kConcave,  // An arc's hollow side.
  };
  Kind kind = Kind::kStraight;
  ElementId element = ElementId::kNone;
  Edge first;  // In the direction of the element, from a to b.
  Edge last;
  // Of an element that passes through the receiver (touching.h): at the directions from the horizon behind up to the
  // key `through` it is there at distance 0. The one that reaches farther is nearer as the receiver moves on; of two
  // that reach as far, the one that leans more toward where it moves.
  bool touches = false;
  double through = -1;
  double lean = 0;
};

// The parts of one element: 2 for an arc cut at its silhouettes or at the receiver's foot point, at most 4.
struct Parts {
  int count = 0;
  Part part[4];
};

Parts PartsOf(const Scene& scene, ElementId element, const Receiver& receiver);

// Distance from the receiver to the part in a unit direction given by its components, which should meet the part; close
// to it otherwise.
double DistanceAlong(const Element& element, const Part& part, const Receiver& receiver, double tangent, double normal);

// Bound on the error of that distance.
double DistanceDoubt(const Scene& scene, const Part& part, const Receiver& receiver, double tangent, double normal,
                     double distance);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_EXACT_PART_H_
