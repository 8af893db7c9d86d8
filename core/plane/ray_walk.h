// SPDX-License-Identifier: Apache-2.0
// What rays meet first, and whether they are blocked: the part of ray casting that runs in vector code.
#ifndef FLATLIGHT_CORE_PLANE_RAY_WALK_H_
#define FLATLIGHT_CORE_PLANE_RAY_WALK_H_

#include <cstdint>
#include <limits>
#include <span>

#include "core/math/vec.h"
#include "core/plane/curve_grid.h"
#include "core/scene/scene.h"

namespace flatlight {

inline constexpr std::uint32_t kNoCarrier = 0xffffffff;
inline constexpr std::uint32_t kNoBlock = 0xffffffff;

// A place where a ray begins or ends. The line or circle that it lies on is not met there.
struct RayEnd {
  Point2 position;
  std::uint32_t carrier = kNoCarrier;
};

struct WalkRay {
  RayEnd from;
  Vector2 direction;
};

struct NearestCrossing {
  double t = std::numeric_limits<double>::infinity();  // In units of the direction's length.
  std::uint32_t element = 0;
  std::uint32_t block = kNoBlock;  // Of the element in the grid, if it is a segment.
  std::uint32_t lane = 0;
};

// The searches, compiled for one vector unit. All units give the same bits.
struct RaySearches {
  // The first element met at t > 0; ties break by (t, element).
  NearestCrossing (*nearest)(const Scene& scene, const CurveGrid& grid, const WalkRay& ray);
  // The same for many rays, which costs less than one after another. Spans of one length.
  void (*nearest_of_many)(const Scene& scene, const CurveGrid& grid, std::span<const WalkRay> rays,
                          std::span<NearestCrossing> nearest);
  // Whether something lies between two places.
  bool (*blocked)(const Scene& scene, const CurveGrid& grid, const RayEnd& from, const RayEnd& to);
  // The same for many pairs of places. Spans of one length.
  void (*blocked_of_many)(const Scene& scene, const CurveGrid& grid, std::span<const RayEnd> from,
                          std::span<const RayEnd> to, std::span<bool> blocked);
  // Whether an element of another line or circle than its own passes through a place, to the scene's touch distance.
  bool (*touched)(const Scene& scene, const CurveGrid& grid, const RayEnd& place);
};

// For the best vector unit of this processor. Never changes, but in tests that choose another.
const RaySearches& ChosenRaySearches();

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_RAY_WALK_H_
