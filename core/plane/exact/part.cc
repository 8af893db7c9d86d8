// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/part.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/math/tolerances.h"

namespace flatlight {
namespace {

// The circle of an arc from the receiver, written about the arc's end a so that no digits are lost as the radius grows:
// v = (x - center)/radius, and f = (|x - center|^2 - radius^2)/(2 radius), positive outside.
struct CircleView {
  Vector2 v;
  double f;

  CircleView(const Element& arc, Point2 x) {
    const Vector2 q = x - arc.a;
    v = arc.radial_a + q / arc.radius;
    f = Dot(q, arc.radial_a) + LengthSquared(q) / (2 * arc.radius);
  }
};

class PartBuilder {
 public:
  PartBuilder(const Scene& scene, ElementId id, const Receiver& receiver)
      : scene_(scene), id_(id), element_(scene.element(id)), receiver_(receiver) {}

  Parts Build() {
    const bool own =
        receiver_.element != ElementId::kNone && scene_.element(receiver_.element).carrier == element_.carrier;
    if (element_.kind == Element::Kind::kSegment) {
      if (!own) Add(Part::Kind::kStraight, VertexEdge(receiver_, element_.a), VertexEdge(receiver_, element_.b));
    } else if (own) {
      BuildOwnCircle();
    } else {
      BuildArc();
    }
    return parts_;
  }

 private:
  // The receiver lies on the arc's circle: seen only from inside.
  void BuildOwnCircle() {
    if (Dot(receiver_.normal, element_.center - receiver_.position) < 0) return;
    const Edge a = VertexEdge(receiver_, element_.a);
    const Edge b = VertexEdge(receiver_, element_.b);
    if (id_ != receiver_.element) {
      Add(Part::Kind::kConcave, a, b);
      return;
    }
    // The element runs on to the horizon on both sides of the receiver; along it, a lies behind. A free point's tangent
    // may run against the element.
    const Vector2 along =
        element_.Orientation() * Left(element_.radial_a + (receiver_.position - element_.a) / element_.radius);
    const double ahead = Dot(along, receiver_.tangent) >= 0 ? 1 : -1;
    Add(Part::Kind::kConcave, a, HorizonEdge(-ahead));
    Add(Part::Kind::kConcave, HorizonEdge(ahead), b);
  }

  void BuildArc() {
    const CircleView view(element_, receiver_.position);
    const double orientation = element_.Orientation();
    const Edge a = VertexEdge(receiver_, element_.a);
    const Edge b = VertexEdge(receiver_, element_.b);
    // Which side each end shows. Arcs that share an end share these bits, so that no silhouette falls between them.
    const bool convex_a = Dot(receiver_.position - element_.a, element_.radial_a) > 0;
    const bool convex_b = Dot(receiver_.position - element_.b, element_.radial_b) > 0;
    const bool middle_inside =
        orientation * Cross(element_.radial_a, view.v) > 0 && orientation * Cross(view.v, element_.radial_b) > 0;
    if (convex_a && convex_b) {
      Add(Part::Kind::kConvex, a, b);
    } else if (convex_a) {
      const Edge silhouette = Silhouette(view, orientation);
      Add(Part::Kind::kConvex, a, silhouette);
      Add(Part::Kind::kConcave, silhouette, b);
    } else if (convex_b) {
      const Edge silhouette = Silhouette(view, -orientation);
      Add(Part::Kind::kConcave, a, silhouette);
      Add(Part::Kind::kConvex, silhouette, b);
    } else if (middle_inside && view.f > 0) {
      const Edge enter = Silhouette(view, -orientation);
      const Edge leave = Silhouette(view, orientation);
      Add(Part::Kind::kConcave, a, enter);
      Add(Part::Kind::kConvex, enter, leave);
      Add(Part::Kind::kConcave, leave, b);
    } else if (middle_inside && view.f < 0) {
      // From inside, an arc near the receiver spans more than half a turn: cut it at the nearest point.
      const double length = Length(view.v);
      const double distance = -2 * view.f / (1 + length);
      const Edge foot = VertexEdge(receiver_, receiver_.position + distance / length * view.v);
      Add(Part::Kind::kConcave, a, foot);
      Add(Part::Kind::kConcave, foot, b);
    } else {
      Add(Part::Kind::kConcave, a, b);
    }
  }

  // The touching point counter-clockwise (side +1) or clockwise (-1) of the circle's nearest point.
  Edge Silhouette(const CircleView& view, double side) const {
    const double root = std::sqrt(std::max(0.0, 2 * view.f / element_.radius));
    const double squared = LengthSquared(view.v);
    const Vector2 direction = (-root * view.v + side * Left(view.v)) / squared;
    const Vector2 outward = (view.v + side * root * Left(view.v)) / squared;
    return SilhouetteEdge(receiver_, element_.radius * root * direction, -element_.radius * outward);
  }

  bool Above(const Edge& edge) const {
    if (edge.kind == Edge::Kind::kHorizon) return true;
    const double reach = std::abs(edge.tangent) + std::abs(edge.normal);
    if (reach < 4 * scene_.coordinate_error()) return false;  // The receiver's own place.
    const double uncertain = 2 * scene_.coordinate_error() + 4 * kUnitRoundoff * reach;
    if (std::abs(edge.normal) > uncertain) return edge.normal > 0;
    // On the horizon: what counts is where it goes as the receiver moves on.
    return -receiver_.curvature * edge.tangent > 0;
  }

  // Adds what lies above the horizon.
  void Add(Part::Kind kind, Edge first, Edge last) {
    const bool above_first = Above(first), above_last = Above(last);
    if (!above_first && !above_last) return;
    if (!above_first) first = Horizon(last, first);
    if (!above_last) last = Horizon(first, last);
    if (first.kind == Edge::Kind::kHorizon && last.kind == Edge::Kind::kHorizon && first.s == last.s) return;
    parts_.part[parts_.count++] = {kind, id_, first, last};
  }

  // Where the way from an edge above the horizon to one below crosses it. Less than half a turn, so the straight way
  // tells.
  Edge Horizon(const Edge& above, const Edge& below) const {
    const double share = above.normal / (above.normal - below.normal);
    const double crossing = above.tangent + share * (below.tangent - above.tangent);
    // Through the receiver itself: as it moves on, the crossing falls behind.
    return HorizonEdge(crossing > 4 * scene_.coordinate_error() ? 1 : -1);
  }

  const Scene& scene_;
  const ElementId id_;
  const Element& element_;
  const Receiver& receiver_;
  Parts parts_;
};

}  // namespace

Parts PartsOf(const Scene& scene, ElementId element, const Receiver& receiver) {
  return PartBuilder(scene, element, receiver).Build();
}

double DistanceAlong(const Element& element, const Part& part, const Receiver& receiver, double tangent,
                     double normal) {
  const Vector2 direction = tangent * receiver.tangent + normal * receiver.normal;
  if (part.kind == Part::Kind::kStraight) {
    const Vector2 along = element.b - element.a;
    const Vector2 a = element.a - receiver.position;
    const Vector2 b = element.b - receiver.position;
    // Within the stretch that the element covers, also where the direction runs along it.
    const double to_a = Dot(a, direction), to_b = Dot(b, direction);
    const double denominator = Cross(direction, along);
    const double t = denominator != 0 ? Cross(a, along) / denominator : 0.5 * (to_a + to_b);
    return std::clamp(t, std::min(to_a, to_b), std::max(to_a, to_b));
  }
  const CircleView view(element, receiver.position);
  const double b = Dot(direction, view.v);
  const double root = std::sqrt(std::max(0.0, b * b - 2 * view.f / element.radius));
  if (part.kind == Part::Kind::kConvex) return 2 * view.f / (root - b);
  return b > 0 ? -2 * view.f / (b + root) : (root - b) * element.radius;
}

}  // namespace flatlight
