// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/edge.h"

#include <cmath>

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

double SineDifference(const Edge& a, const Edge& b, const Receiver& receiver) {
  const double cosine = a.c * b.c + a.s * b.s;
  if (!(cosine > 0) || a.kind == Edge::Kind::kHorizon || b.kind == Edge::Kind::kHorizon) return b.s - a.s;
  double cross;
  if (a.kind == Edge::Kind::kVertex && b.kind == Edge::Kind::kVertex) {
    // About the nearer one, beside whose distance nothing is large.
    const Vector2 e = b.point - a.point;
    const Edge& nearer = a.q > b.q ? a : b;
    cross = Dot(receiver.tangent, e) * nearer.normal - Dot(receiver.normal, e) * nearer.tangent;
  } else {
    cross = b.tangent * a.normal - b.normal * a.tangent;
  }
  return cross * a.q * b.q * (a.c + b.c) / (1 + cosine);
}

}  // namespace flatlight
