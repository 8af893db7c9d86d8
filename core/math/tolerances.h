// SPDX-License-Identifier: Apache-2.0
// Every tolerance of the transport core. Lengths are in normalised units: all curves lie in [-1, 1]^2.
#ifndef FLATLIGHT_CORE_MATH_TOLERANCES_H_
#define FLATLIGHT_CORE_MATH_TOLERANCES_H_

namespace flatlight {

// Half a unit in the last place of 1: the rounding of one operation on numbers near 1.
inline constexpr double kUnitRoundoff = 0x1p-53;

// How far apart two curves may be and still touch, for rays, in a scene around the origin; Scene::touch_distance()
// scales it with the coordinates that the author had to round. Rounding places a curve's end up to 2 roundoffs from
// where its neighbour passes. Smaller: light leaks through T-junctions. Larger: gaps of this width close (a keyhole of
// 1e-7 narrows by 2e-8 of itself).
inline constexpr double kTouchDistance = 8 * kUnitRoundoff;

// Curves overlap if one runs within this distance of another for longer than this. Larger than kTouchDistance because
// the direction of a short piece is uncertain.
inline constexpr double kOverlapDistance = 4 * kTouchDistance;

// A free probe point on a curve whose normal is not the curve's is moved off the curve by so many times the distance
// within which it lies on it, to the side its normal points to. The error of irradiance is of this order, relative to
// the nearest vertex's distance; above an arc it is of the order of the square root, relative to the radius.
inline constexpr double kLiftTouches = 128;

// Where another curve passes through a receiver, light is that just beyond it, toward increasing arc length: rays start
// so many touch distances farther on. The error is of this order, relative to the distance of the nearest vertex.
inline constexpr double kOnwardTouches = 1024;

// A curve that leaves the receiver at a small angle, or touches it, is still not told from it there: rays then start
// farther on, up to this. Smaller: a circle of radius 1 that touches the receiver is on neither side of it.
inline constexpr double kFarthestOnward = 0x1p-20;

// A Bézier curve is followed by arcs to this share of its size, but no closer than touching curves are. Smaller: more
// arcs, by the third root. What the arcs leave open is measured, and part of stated errors.
inline constexpr double kBezierShare = 1e-8;

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_MATH_TOLERANCES_H_
