// SPDX-License-Identifier: Apache-2.0
#include "core/plane/ray_tracing/end_finder.h"

#include <cmath>

namespace flatlight {

namespace {

// Whether an edge above the horizon lies between two rays, of which the near one may be in its direction.
bool LiesBetween(const Edge& edge, const GatheredRay& near, const GatheredRay& far) {
  const bool between =
      near.sine < far.sine ? near.sine <= edge.s && edge.s < far.sine : far.sine < edge.s && edge.s <= near.sine;
  return between && edge.c > 0;
}

// Whether one element of a Bézier goes over into the next without a corner.
bool GoesOn(const Element& before, const Element& after) {
  return before.b == after.a && before.kind == Element::Kind::kArc && after.kind == Element::Kind::kArc &&
         before.Orientation() * after.Orientation() * Dot(before.radial_b, after.radial_a) > 0;
}

}  // namespace

std::optional<Edge> EndFinder::Between(const GatheredRay& a, const GatheredRay& b) const {
  if (a.element == b.element) return std::nullopt;
  const bool a_is_near = a.InverseDistance() >= b.InverseDistance();
  const GatheredRay &near = a_is_near ? a : b, &far = a_is_near ? b : a;
  const Element& piece = scene_.element(near.element);
  // An arc that turns away ends there, wherever its own end hides.
  if (piece.kind == Element::Kind::kArc) {
    if (const std::optional<Edge> found = Silhouette(near.element, near, far)) return found;
  }
  // A Bézier goes on through elements that no ray has met.
  if (const BezierPiece* on = scene_.bezier_piece(piece)) return OnBezier(*on, piece, near, far);
  for (const Point2 end : {piece.a, piece.b}) {
    if (end == receiver_.position) continue;
    const Edge edge = VertexEdge(receiver_, end);
    if (LiesBetween(edge, near, far)) return edge;
  }
  return std::nullopt;
}

std::optional<Edge> EndFinder::OnBezier(const BezierPiece& on, const Element& piece, const GatheredRay& near,
                                        const GatheredRay& far) const {
  const Curve& curve = scene_.curve(piece.curve);
  const Element* last = nullptr;
  for (std::uint32_t e = 0; e < curve.element_count; ++e) {
    const auto id = static_cast<ElementId>(curve.first_element + e);
    const Element& other = scene_.element(id);
    const BezierPiece* const beside = scene_.bezier_piece(other);
    if (beside == nullptr || beside->bezier != on.bezier) continue;
    if (id != near.element && other.kind == Element::Kind::kArc) {
      if (const std::optional<Edge> found = Silhouette(id, near, far)) return found;
    }
    // Its own ends, and the tips of its cusps.
    if (last == nullptr || !GoesOn(*last, other)) {
      const Edge edge = VertexEdge(receiver_, other.a);
      if (other.a != receiver_.position && LiesBetween(edge, near, far)) return edge;
    }
    last = &other;
  }
  if (last == nullptr) return std::nullopt;
  const Edge edge = VertexEdge(receiver_, last->b);
  return last->b != receiver_.position && LiesBetween(edge, near, far) ? std::optional(edge) : std::nullopt;
}

std::optional<Edge> EndFinder::Silhouette(ElementId id, const GatheredRay& near, const GatheredRay& far) const {
  const Element& piece = scene_.element(id);
  const Vector2 to_center = piece.center - receiver_.position;
  const double squared = LengthSquared(to_center), beyond = squared - piece.radius * piece.radius;
  if (!(beyond > 0)) return std::nullopt;  // From inside there is none.
  const double tangent_length = std::sqrt(beyond);
  // The touching point on the side of the far ray.
  const bool left = Cross(near.to, far.sine * receiver_.tangent + far.cosine * receiver_.normal) > 0;
  const Vector2 aside = (left ? piece.radius : -piece.radius) * Left(to_center);
  const Vector2 to = (tangent_length / squared) * (tangent_length * to_center + aside);
  Edge edge = SilhouetteEdge(receiver_, to, to_center - to);
  edge.element = id;
  if (!LiesBetween(edge, near, far) || !OnArc(scene_.curve(piece.curve), piece, edge.point)) return std::nullopt;
  return scene_.bezier_piece(piece) != nullptr ? TrueEdge(scene_, receiver_, edge) : edge;
}

bool EndFinder::OnArc(const Curve& curve, const Element& piece, Point2 point) const {
  const Vector2 radial = point - piece.center;
  for (std::uint32_t e = 0; e < curve.element_count; ++e) {
    const Element& arc = scene_.element(static_cast<ElementId>(curve.first_element + e));
    if (arc.kind != Element::Kind::kArc || arc.carrier != piece.carrier) continue;
    const double sign = arc.Orientation();
    if (sign * Cross(arc.radial_a, radial) >= 0 && sign * Cross(radial, arc.radial_b) >= 0 &&
        Dot(radial, arc.radial_a + arc.radial_b) > 0) {
      return true;
    }
  }
  return false;
}

}  // namespace flatlight
