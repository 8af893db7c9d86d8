// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/edge.h"

#include <algorithm>
#include <cmath>

#include "core/scene/bezier_chain.h"

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

Edge TrueEdge(const Scene& scene, const Receiver& receiver, const Edge& edge) {
  if (edge.kind == Edge::Kind::kHorizon || edge.kind == Edge::Kind::kTouch) return edge;
  Receiver itself = receiver;
  itself.position = receiver.position + receiver.offset;
  const Element* const element = edge.element == ElementId::kNone ? nullptr : &scene.element(edge.element);
  const BezierPiece* const on = element == nullptr ? nullptr : scene.bezier_piece(*element);
  // Where elements meet the curve has no corner: light ends where it touches the direction, beside the joint.
  const bool joint = edge.kind == Edge::Kind::kVertex;
  Edge found = VertexEdge(itself, edge.point);
  found.kind = edge.kind, found.signed_radius = edge.signed_radius, found.element = edge.element;
  found.crossing = edge.crossing;
  found.turn = edge.turn, found.stretch = edge.stretch;
  if (on == nullptr || !(on->bends || joint)) return found;
  // If nothing better is found: it is as far off as elements may be, or as they are long.
  const double off = scene.bezier_distance() + (on->bends ? 0 : element->length);
  found.turn += 2 * off * found.q, found.stretch += 2 * off * found.q;
  found.radius_error = joint ? off : std::abs(edge.signed_radius);
  const Bezier& bezier = scene.beziers()[on->bezier];
  const Vector2 chord = element->b - element->a;
  const double share = Dot(edge.point - element->a, chord) / LengthSquared(chord);
  double u = on->from + share * (on->to - on->from);
  // The touching point may be a little beyond the stretch.
  const double reach = on->to - on->from;
  const double low = std::max(0.0, on->from - reach), high = std::min(1.0, on->to + reach);
  Vector2 to, first;
  for (int i = 0; i < 20; ++i) {
    // The sine of the angle between the direction and the tangent is 0, also where the curve comes to a stand nearby.
    to = bezier.At(u) - itself.position, first = bezier.First(u);
    const double turn = Cross(first, bezier.Second(u)) * Dot(to, first);
    const double next = std::clamp(u - Cross(to, first) * LengthSquared(first) / turn, low, high);
    if (!(std::abs(next - u) > 4 * kUnitRoundoff)) break;
    u = next;
  }
  const Point2 touch = bezier.At(u);
  // No such place in reach, at the end of it for instance.
  constexpr double kTouches = 1e-6;
  if (!(std::abs(Cross(to, first)) <= kTouches * Length(to) * Length(first))) return found;
  if (!(Length(touch - edge.point) <= element->length + 2 * off)) return found;
  const Edge unknown = found;
  found = VertexEdge(itself, touch);  // Known as coordinates are, whatever arcs meet there.
  found.kind = Edge::Kind::kSilhouette, found.element = edge.element;
  // At an inflection, and where the curve stands still, the arc's.
  const double curvature = bezier.Curvature(u), radius = std::abs(1 / curvature);
  const Vector2 inward = curvature * Left(first);
  const double toward = found.c * Dot(receiver.tangent, inward) - found.s * Dot(receiver.normal, inward);
  if (joint && !std::isfinite(radius)) return unknown;
  found.signed_radius =
      std::isfinite(radius) ? std::copysign(radius, joint ? toward : edge.signed_radius) : edge.signed_radius;
  found.radius_error = std::abs(found.signed_radius);
  if (!std::isfinite(radius)) return found;
  // The place slides by as much as the direction is off.
  Receiver there;
  there.curvature = curvature, there.curvature_change = bezier.CurvatureChange(u);
  const double coordinate_error = scene.coordinate_error() + receiver.displaced;
  const double slides = radius * (2 * coordinate_error * found.q + receiver.tilt + 4 * kUnitRoundoff);
  BoundPlaceOnBezier(bezier, u, slides, scene.coordinate_error(), there);
  const double error = radius * radius * there.curvature_error;
  if (std::isfinite(error)) found.radius_error = error;
  return found;
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
