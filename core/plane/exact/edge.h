// SPDX-License-Identifier: Apache-2.0
// A direction in which a visible piece begins or ends, and how it moves with the receiver.
#ifndef FLATLIGHT_CORE_PLANE_EXACT_EDGE_H_
#define FLATLIGHT_CORE_PLANE_EXACT_EDGE_H_

#include <algorithm>
#include <cmath>

#include "core/math/tolerances.h"
#include "core/math/vec.h"
#include "core/scene/scene.h"

namespace flatlight {

// Directions from a receiver are measured from its normal toward its tangent: theta in [-pi/2, pi/2] above the horizon.
struct Edge {
  enum class Kind : unsigned char {
    kVertex,      // A fixed point: an end of a piece, or a place where two cross.
    kSilhouette,  // The touching point of a tangent to an arc; it slides as the receiver moves.
    kTouch,       // The same of an arc that passes through the receiver, where its derivatives have no bound.
    kHorizon,  // The receiver's own horizon, where everything below is cut off: theta = +-pi/2, whatever moves there.
  };
  Kind kind = Kind::kVertex;
  double tangent = 0;  // Components of the vector from the receiver to the point; +-1, 0 at the horizon.
  double normal = 0;
  double key = 0;  // In [-1, 1], increasing with theta: tangent/(|tangent| + normal).
  double s = 0;    // sin theta
  double c = 0;    // cos theta
  double q = 0;    // 1/distance
  // Silhouettes: the arc's radius, positive if its centre lies toward +theta of the touching point.
  double signed_radius = 0;
  // Bounds on errors beyond those of the coordinates: of theta, and of the distance, relative.
  double turn = 0;
  double stretch = 0;
  double radius_error = 0;               // Of signed_radius.
  Point2 point;                          // Not at the horizon.
  ElementId element = ElementId::kNone;  // Silhouettes: the arc. Vertices where a Bézier goes on: an element of it.
  bool crossing = false;                 // Vertices: where two curves cross.

  double Distance() const { return 1 / q; }
};

// The unit direction of a key, in the receiver's components.
struct UnitDirection {
  double tangent;
  double normal;

  explicit UnitDirection(double key) {
    const double n = 1 - std::abs(key);
    const double length = std::sqrt(key * key + n * n);
    tangent = key / length;
    normal = n / length;
  }
};

Edge VertexEdge(const Receiver& receiver, Point2 point);
// `touch`: from the receiver to the touching point; `inward`: from there to the centre, of the circle's radius.
Edge SilhouetteEdge(const Receiver& receiver, Vector2 touch, Vector2 inward);
Edge HorizonEdge(double sign);
// The same edge as a receiver on a Bézier sees it, or of one: at the place itself, with the Bézier's touching point and
// its radius of curvature there, where elements stand for it to the distance Scene::bezier_distance().
Edge TrueEdge(const Scene& scene, const Receiver& receiver, const Edge& edge);
// A vertex whose components are known; without its key.
inline void SetVertexEdge(double tangent, double normal, Point2 point, Edge& edge) {
  edge.kind = Edge::Kind::kVertex;
  edge.crossing = false;
  edge.tangent = tangent, edge.normal = normal;
  edge.q = 1 / std::sqrt(tangent * tangent + normal * normal);
  edge.s = tangent * edge.q;
  edge.c = normal * edge.q;
  edge.signed_radius = edge.turn = edge.stretch = edge.radius_error = 0;
  edge.point = point;
}

// sin theta_b - sin theta_a without losing the digits of a narrow piece: with the half-angle formula, and the piece's
// own extent where both ends are its own.
double SineDifference(const Edge& a, const Edge& b, const Receiver& receiver);

// How sin(theta) changes per arc length along the receiver's tangent. For the break law theta' = kappa - c q,
// q' = s q^2 + R c q^3 (R the signed radius) see Jarosz et al. 2012 for the straight receiver; here for curved
// receivers and sliding silhouettes.
struct EdgeDerivatives {
  double theta_first = 0;
  double theta_second = 0;
  double s_first = 0;
  double s_second = 0;
};
inline EdgeDerivatives Derive(const Edge& edge, double curvature, double curvature_change = 0) {
  if (edge.kind == Edge::Kind::kHorizon) return {};
  const double s = edge.s, c = edge.c, q = edge.q;
  EdgeDerivatives d;
  d.theta_first = curvature - c * q;
  d.theta_second = curvature_change + curvature * s * q - 2 * s * c * q * q - edge.signed_radius * c * c * q * q * q;
  d.s_first = c * d.theta_first;
  d.s_second = c * d.theta_second - s * d.theta_first * d.theta_first;
  return d;
}

// Bounds on the rounding errors of s, c, s', s'' when every coordinate is known to `coordinate_error`.
struct EdgeErrors {
  double s = 0;
  double c = 0;
  double s_first = 0;
  double s_second = 0;
};
inline EdgeErrors BoundErrors(const Edge& edge, double curvature, double coordinate_error,
                              double curvature_change = 0) {
  if (edge.kind == Edge::Kind::kHorizon) return {};
  // An edge may lie below the horizon by the accuracy of the coordinates.
  const double c = std::abs(edge.c), q = edge.q, k = std::abs(curvature), r = std::abs(edge.signed_radius);
  constexpr double u = kUnitRoundoff;
  if (edge.kind == Edge::Kind::kTouch) {
    const EdgeDerivatives d = Derive(edge, curvature);
    return {2 * (c * edge.turn + 4 * u), 2 * (edge.turn + 4 * u), std::abs(d.s_first), std::abs(d.s_second)};
  }
  // The direction turns by the displacement over the distance; a touching point slides with it.
  const double turn = 2 * coordinate_error * q + 4 * u + edge.turn;
  const double cq = c * q, ccq = c * c * q, ccqq = ccq * q;
  EdgeErrors e;
  e.s = std::min(2.0, (c + edge.turn) * turn) + 4 * u;
  e.c = std::min(1.0, turn) + 4 * u;
  if (k == 0 && r == 0 && curvature_change == 0) {
    e.s_first = (2 * cq + ccq) * turn + ccq * edge.stretch + 8 * u * ccq;
    e.s_second = (9 * cq * q + 6 * ccqq) * turn + 6 * ccqq * edge.stretch + 48 * u * ccqq;
  } else {
    const double relative_q = turn * (1 + r * q) + edge.stretch, rccqqq = r * ccqq * q;
    e.s_first = (k + 2 * cq) * turn + ccq * relative_q + 8 * u * (k * c + ccq);
    e.s_second =
        (k * k + 6 * k * q + 9 * cq * q + 3 * rccqqq) * turn + (3 * k * cq + 6 * ccqq + 3 * c * rccqqq) * relative_q +
        16 * u * (k * k + 3 * k * cq + 3 * ccqq + c * rccqqq) + std::abs(curvature_change) * (turn + 64 * u * c);
  }
  return {2 * e.s, 2 * e.c, 2 * e.s_first, 2 * e.s_second};
}

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_EXACT_EDGE_H_
