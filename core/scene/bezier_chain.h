// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_SCENE_BEZIER_CHAIN_H_
#define FLATLIGHT_CORE_SCENE_BEZIER_CHAIN_H_

#include <cstdint>
#include <vector>

#include "core/math/bezier.h"
#include "core/scene/scene.h"

namespace flatlight {

// A Bézier curve as a chain of arcs (of a few segments where it is as good as straight) that go over into each other
// without a corner: pairs of arcs that share places and tangents with the curve (biarcs; Bolton 1975), as many as it
// takes to stay within a distance of it.
struct BezierChain {
  struct Piece {
    Element element;  // Of its curve nothing but the shape.
    BezierPiece on;   // Without its Bézier's number.
  };
  std::vector<Piece> pieces;
};

// `tolerance` > 0: no piece is farther from the curve, as measured at several places of each.
BezierChain MakeBezierChain(const Bezier& bezier, double tolerance);

// Puts a receiver on a piece, at a parameter of its Bézier: the curve's place, frame and curvature, looking to the
// front (sign +1) or the back (-1). Its position is the point of the piece beside that of the curve.
void PlaceOnBezier(const Element& element, const Bezier& bezier, double u, double sign, Receiver& receiver);

// Bounds what the place and the frame of such a receiver may be off by, if its arc length is known to `along` and
// control points to `coordinate_error`.
void BoundPlaceOnBezier(const Bezier& bezier, double u, double along, double coordinate_error, Receiver& receiver);

// The parameter in [low, high] at which a Bézier is nearest to a point, from a guess.
double NearestOnBezier(const Bezier& bezier, Point2 point, double low, double high, double guess);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_SCENE_BEZIER_CHAIN_H_
