// SPDX-License-Identifier: Apache-2.0
// A part as the envelope compares it: in the receiver's components, with bounds on what rounding may hide.
#ifndef FLATLIGHT_CORE_PLANE_EXACT_SIGHT_H_
#define FLATLIGHT_CORE_PLANE_EXACT_SIGHT_H_

#include <cstdint>

#include "core/math/vec.h"
#include "core/plane/exact/part.h"
#include "core/scene/scene.h"

namespace flatlight {

// A direction in which a sight begins or ends.
struct SightEnd {
  enum class Kind : std::uint8_t {
    kVertex,   // A point.
    kHorizon,  // tangent +-1, normal 0.
    kEdge,     // An edge of the part.
  };
  double tangent = 0;  // From the receiver; of any length.
  double normal = 0;
  double key = 0;
  double uncertain = 0;        // How far the key may be off, twice.
  Point2 point;                // kVertex.
  const Edge* edge = nullptr;  // kEdge.
  Kind kind = Kind::kVertex;
  bool crossing = false;  // kVertex: where two elements cross.

  bool SamePlace(const SightEnd& other) const {
    return tangent == other.tangent && normal == other.normal &&
           (kind == Kind::kHorizon) == (other.kind == Kind::kHorizon);
  }
};

// What is seen of an element between two directions, if nothing hides it.
struct Sight {
  // Straight ones, on the line from `low` to `high` (along theta): a ray of direction d meets it at
  // area / Cross(d, along) lengths of d.
  double along_tangent = 0;
  double along_normal = 0;
  double area = 0;
  // Bounds on the errors of `area`, and of Cross(d, along) for a d of length 1.
  double area_doubt = 0;
  double along_doubt = 0;
  // No point of it is nearer or farther.
  double near_squared = 0;
  double far_squared = 0;
  ElementId element = ElementId::kNone;
  bool front = true;           // The side that is seen.
  const Part* part = nullptr;  // Arcs.

  double CrossAlong(const SightEnd& d) const { return d.normal * along_tangent - d.tangent * along_normal; }
};

struct SightBetween {
  Sight sight;
  SightEnd low;
  SightEnd high;
};

enum class Seen {
  kNothing,
  kPart,
  kDoubt,  // It meets the horizon or the receiver, or is seen edge-on, to the accuracy of the coordinates.
};

// A segment that the receiver does not lie on.
Seen SeeSegment(const Scene& scene, const Receiver& receiver, Point2 a, Point2 b, bool left_handed, SightBetween& seen);

// A part in full. It must outlive the sight. kDoubt if it is seen edge-on.
Seen SeePart(const Scene& scene, const Receiver& receiver, const Part& part, bool left_handed, SightBetween& seen);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_EXACT_SIGHT_H_
