// SPDX-License-Identifier: Apache-2.0
// A direction in which a visible piece begins or ends, and how it moves with the receiver.
#ifndef FLATLIGHT_CORE_PLANE_EXACT_EDGE_H_
#define FLATLIGHT_CORE_PLANE_EXACT_EDGE_H_

#include <cmath>

#include "core/math/vec.h"
#include "core/scene/scene.h"

namespace flatlight {

// Directions from a receiver are measured from its normal toward its tangent: theta in [-pi/2, pi/2] above the horizon.
struct Edge {
  enum class Kind : unsigned char {
    kVertex,      // A fixed point: an end of a piece, or a place where two cross.
    kSilhouette,  // The touching point of a tangent to an arc; it slides as the receiver moves.
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
  Point2 point;  // Not at the horizon.

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

// How sin(theta) changes per arc length along the receiver's tangent. For the break law theta' = kappa - c q,
// q' = s q^2 + R c q^3 (R the signed radius) see Jarosz et al. 2012 for the straight receiver; here for curved
// receivers and sliding silhouettes.
struct EdgeDerivatives {
  double theta_first = 0;
  double theta_second = 0;
  double s_first = 0;
  double s_second = 0;
};
EdgeDerivatives Derive(const Edge& edge, double curvature);

// Bounds on the rounding errors of s, s', s'' when every coordinate is known to `coordinate_error`.
struct EdgeErrors {
  double s = 0;
  double s_first = 0;
  double s_second = 0;
};
EdgeErrors BoundErrors(const Edge& edge, double curvature, double coordinate_error);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_EXACT_EDGE_H_
