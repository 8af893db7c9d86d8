// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_SHAFT_H_
#define FLATLIGHT_CORE_PLANE_SHAFT_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/math/vec.h"
#include "core/plane/box.h"
#include "core/plane/bvh.h"
#include "core/scene/scene.h"

namespace flatlight {

// A few points; they stand for everything in their convex hull.
struct Corners {
  std::array<Point2, 4> point;
  std::size_t count = 0;

  void Add(Point2 p) { point[count++] = p; }
};

Corners CornersOf(Point2 point);
Corners CornersOf(const Box& box);
// The ends; for an arc also where the tangents at its ends meet (an arc turns by at most a quarter).
Corners CornersOf(const Element& element);

// Whether the corners lie well inside the circle of an arc.
bool CircleHolds(const Element& arc, const Corners& corners);

// What the curves do to the straight lines from one convex set to another.
enum class Passage : std::uint8_t {
  kClear,      // No curve comes near any of them.
  kHidden,     // One straight piece crosses all of them.
  kUncertain,  // Neither can be told.
};

// Carriers of the two sets' own elements; pieces on them are not looked at.
struct OwnCarriers {
  std::uint32_t from = 0xffffffff;
  std::uint32_t to = 0xffffffff;
};

// Looks at the shaft between two sets, their common convex hull. A piece that touches it in no more than a corner that
// both share, bit for bit, or runs along its edge from corner to corner, leaves it clear: lines between inner points of
// the sets do not meet it. Nearer than a few touch distances, everything else counts as in the way.
Passage PassageBetween(const Scene& scene, const Bvh& bvh, const Corners& from, const Corners& to,
                       const OwnCarriers& own);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_SHAFT_H_
