// SPDX-License-Identifier: Apache-2.0
// The directions in which a piece of an emitter lies. Irradiance is radiance integrated over the sine of the angle
// (cos(theta) dtheta = d(sin theta)), so that uniform sampling of sines leaves visibility as the only noise.
#ifndef FLATLIGHT_CORE_PLANE_PATH_TRACING_EMITTER_RANGE_H_
#define FLATLIGHT_CORE_PLANE_PATH_TRACING_EMITTER_RANGE_H_

#include <cstdint>

#include "core/plane/path_tracing/vertex.h"
#include "core/scene/scene.h"

namespace flatlight {

enum class EmittingSides : std::uint8_t { kFront, kBoth };

// What a vertex sees of the emitting sides of one element above its horizon, other elements aside.
struct EmitterRange {
  enum class Kind : std::uint8_t {
    kNone,
    kSines,   // All directions whose sines lie between low and low + width, each showing one point.
    kLength,  // Not one such interval (an arc seen partly from inside, partly from outside): sample its length.
  };
  Kind kind = Kind::kNone;
  bool far = false;    // kSines, arcs: a ray meets the piece where it leaves the circle, not where it enters it.
  bool alone = false;  // Nothing of the piece's own line or circle comes before any of these points.
  double low = 0;
  double width = 0;  // kLength: a guess at it, positive.
};

EmitterRange RangeOf(const Element& element, EmittingSides sides, const Vertex& vertex);

// The point of the element that lies in a direction of its range (kSines).
Point2 PointInDirection(const Element& element, const EmitterRange& range, const Vertex& vertex, Vector2 direction);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_PATH_TRACING_EMITTER_RANGE_H_
