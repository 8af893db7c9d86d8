// SPDX-License-Identifier: Apache-2.0
// The directions in which a straight or circular emitter lies. Irradiance is radiance integrated over the sine of the
// angle (cos(theta) dtheta = d(sin theta)), so that uniform sampling of this interval leaves visibility as the only
// noise.
#ifndef FLATLIGHT_CORE_PLANE_PATH_TRACING_SINE_INTERVAL_H_
#define FLATLIGHT_CORE_PLANE_PATH_TRACING_SINE_INTERVAL_H_

#include "core/plane/path_tracing/vertex.h"
#include "core/scene/scene.h"

namespace flatlight {

// Sines from `low` to `low + width`; empty if the width is 0.
struct SineInterval {
  double low = 0;
  double width = 0;
  bool empty() const { return !(width > 0); }
};

enum class EmittingSides { kFront, kBoth };

// Where a segment shows an emitting side above the vertex's horizon. Occlusion is not considered.
SineInterval SegmentInterval(const Element& segment, EmittingSides sides, const Vertex& vertex);

// The same for a full circle, whichever side of it the vertex is on.
SineInterval CircleInterval(const Element& circle, EmittingSides sides, const Vertex& vertex);

// The point of the segment that lies in a direction of its interval.
Point2 PointOnSegment(const Element& segment, const Vertex& vertex, Vector2 direction);

// The point of the circle that lies in a direction of its interval: the near one from outside, the far one from inside.
Point2 PointOnCircle(const Element& circle, const Vertex& vertex, Vector2 direction);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_PATH_TRACING_SINE_INTERVAL_H_
