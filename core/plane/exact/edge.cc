// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/edge.h"

#include <cmath>

#include "core/math/tolerances.h"

namespace flatlight {
namespace {

Edge DirectedEdge(const Receiver& receiver, Vector2 to_point) {
  Edge edge;
  edge.tangent = Dot(receiver.tangent, to_point);
  edge.normal = Dot(receiver.normal, to_point);
  const double distance = std::sqrt(edge.tangent * edge.tangent + edge.normal * edge.normal);
  edge.q = 1 / distance;
  edge.s = edge.tangent * edge.q;
  edge.c = edge.normal * edge.q;
  edge.key = edge.tangent / (std::abs(edge.tangent) + edge.normal);
  return edge;
}

}  // namespace

Edge VertexEdge(const Receiver& receiver, Point2 point) {
  Edge edge = DirectedEdge(receiver, point - receiver.position);
  edge.point = point;
  return edge;
}

Edge SilhouetteEdge(const Receiver& receiver, Vector2 touch, Vector2 inward) {
  Edge edge = DirectedEdge(receiver, touch);
  edge.kind = Edge::Kind::kSilhouette;
  edge.point = receiver.position + touch;
  const double toward = edge.c * Dot(receiver.tangent, inward) - edge.s * Dot(receiver.normal, inward);
  edge.signed_radius = std::copysign(Length(inward), toward);
  return edge;
}

Edge HorizonEdge(double sign) {
  Edge edge;
  edge.kind = Edge::Kind::kHorizon;
  edge.tangent = edge.key = edge.s = sign;
  return edge;
}

EdgeDerivatives Derive(const Edge& edge, double curvature) {
  if (edge.kind == Edge::Kind::kHorizon) return {};
  const double s = edge.s, c = edge.c, q = edge.q;
  EdgeDerivatives d;
  d.theta_first = curvature - c * q;
  d.theta_second = curvature * s * q - 2 * s * c * q * q - edge.signed_radius * c * c * q * q * q;
  d.s_first = c * d.theta_first;
  d.s_second = c * d.theta_second - s * d.theta_first * d.theta_first;
  return d;
}

EdgeErrors BoundErrors(const Edge& edge, double curvature, double coordinate_error) {
  if (edge.kind == Edge::Kind::kHorizon) return {};
  const double c = edge.c, q = edge.q, k = std::abs(curvature), r = std::abs(edge.signed_radius);
  constexpr double u = kUnitRoundoff;
  // The direction turns by the displacement over the distance; a touching point slides with it.
  const double turn = 2 * coordinate_error * q + 4 * u;
  const double relative_q = turn * (1 + r * q);
  EdgeErrors e;
  e.s = c * turn + 4 * u;
  e.s_first = (k + 2 * c * q) * turn + c * c * q * relative_q + 8 * u * (k * c + c * c * q);
  e.s_second = (k * k + 6 * k * q + 9 * c * q * q + 3 * r * c * c * q * q * q) * turn +
               (3 * k * c * q + 6 * c * c * q * q + 3 * r * c * c * c * q * q * q) * relative_q +
               16 * u * (k * k + 3 * k * c * q + 3 * c * c * q * q + r * c * c * c * q * q * q);
  return {2 * e.s, 2 * e.s_first, 2 * e.s_second};
}

}  // namespace flatlight
