// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/part.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/math/tolerances.h"
#include "core/plane/exact/touching.h"

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
    const bool own_run = InOwnRun();
    if (!own && BuildCorner()) return parts_;
    if (!own && !own_run && MayTouch() && TouchesReceiver(scene_, element_, receiver_))
      return TouchingParts(scene_, id_, receiver_);
    if (element_.kind == Element::Kind::kSegment) {
      if (!own) Add(Part::Kind::kStraight, OwnEnd(element_.a), OwnEnd(element_.b));
    } else if (own_run) {
      // The receiver's own Bézier, which bends to one side: seen from its hollow side, and up to the receiver.
      const Element& own_element = scene_.element(receiver_.element);
      if (Dot(receiver_.normal, own_element.center - receiver_.position) >= 0) BuildOwnRun();
    } else if (own) {
      BuildOwnCircle();
    } else {
      BuildArc();
    }
    return parts_;
  }

 private:
  // A straight element that has an end in common with the receiver's own, which is straight too. They meet nowhere
  // else: however near to it the receiver is, the corner's turn tells on which side of it.
  bool BuildCorner() {
    if (receiver_.element == ElementId::kNone || element_.kind != Element::Kind::kSegment) return false;
    const Element& own = scene_.element(receiver_.element);
    if (own.kind != Element::Kind::kSegment) return false;
    const bool at_a = element_.a == own.a || element_.a == own.b;
    if (!at_a && element_.b != own.a && element_.b != own.b) return false;
    const Point2 corner = at_a ? element_.a : element_.b, end = at_a ? element_.b : element_.a;
    if (IsOwnPlace(corner)) return false;
    const double height = Dot(receiver_.normal, end - corner);
    if (std::abs(height) <= scene_.touch_distance()) return false;
    const Edge begins = HorizonEdge(Dot(receiver_.tangent, corner - receiver_.position) > 0 ? 1 : -1);
    if (height < 0) return true;
    Edge ends = VertexEdge(receiver_, end);
    if (!Above(ends)) return false;
    AddAbove(Part::Kind::kStraight, at_a ? begins : ends, at_a ? ends : begins);
    return true;
  }

  // False where that is plain at little cost.
  bool MayTouch() const {
    if (element_.kind == Element::Kind::kSegment) return true;
    const double touch = scene_.touch_distance();
    return std::abs(CircleView(element_, receiver_.position).f) <=
           2 * touch + 4 * scene_.coordinate_error() + touch * touch / element_.radius;
  }

  // The receiver lies on the arc's circle: seen only from inside.
  void BuildOwnCircle() {
    if (Dot(receiver_.normal, element_.center - receiver_.position) < 0) return;
    // Along the element, a lies behind. A free point's tangent may run against the element.
    const Vector2 along =
        element_.Orientation() * Left(element_.radial_a + (receiver_.position - element_.a) / element_.radius);
    const double ahead = Dot(along, receiver_.tangent) >= 0 ? 1 : -1;
    const bool at_a = IsOwnPlace(element_.a), at_b = IsOwnPlace(element_.b);
    if (id_ == receiver_.element) {
      // It runs on to the horizon on both sides of the receiver.
      if (!at_a) AddAbove(Part::Kind::kConcave, OwnVertex(element_.a), HorizonEdge(-ahead));
      if (!at_b) AddAbove(Part::Kind::kConcave, HorizonEdge(ahead), OwnVertex(element_.b));
    } else {
      AddAbove(Part::Kind::kConcave, at_a ? HorizonEdge(ahead) : OwnVertex(element_.a),
               at_b ? HorizonEdge(-ahead) : OwnVertex(element_.b));
    }
  }

  bool InOwnRun() const {
    const BezierPiece* const on = scene_.bezier_piece(element_);
    if (on == nullptr || !on->bends || receiver_.element == ElementId::kNone) return false;
    const BezierPiece* const from = scene_.bezier_piece(scene_.element(receiver_.element));
    return from != nullptr && from->bends && from->run == on->run;
  }

  // The receiver looks along the Bézier, not along the arc: each end is above its horizon or not, for both arcs that
  // meet there alike.
  void BuildOwnRun() {
    const Edge a = OwnEnd(element_.a), b = OwnEnd(element_.b);
    if (id_ != receiver_.element) return Add(Part::Kind::kConcave, a, b);
    const Vector2 along =
        element_.Orientation() * Left(element_.radial_a + (receiver_.position - element_.a) / element_.radius);
    const double ahead = Dot(along, receiver_.tangent) >= 0 ? 1 : -1;
    if (Above(a)) AddAbove(Part::Kind::kConcave, a, HorizonEdge(-ahead));
    if (Above(b)) AddAbove(Part::Kind::kConcave, HorizonEdge(ahead), b);
  }

  bool IsOwnPlace(Point2 point) const { return Length(point - receiver_.position) <= scene_.touch_distance(); }

  // A point of the receiver's own circle: above the horizon by |d|^2/(2 r), however near it is.
  Edge OwnVertex(Point2 point) const {
    Edge edge = VertexEdge(receiver_, point);
    const double squared = LengthSquared(point - receiver_.position);
    edge.normal = squared / (2 * element_.radius);
    edge.c = edge.normal * edge.q;
    // A short chord's direction is rounding, unlike its length.
    if (edge.c < 0.5) {
      edge.tangent = std::copysign(std::sqrt(squared - edge.normal * edge.normal), edge.tangent);
      edge.s = edge.tangent * edge.q;
    }
    edge.key = edge.tangent / (std::abs(edge.tangent) + edge.normal);
    return edge;
  }

  void BuildArc() {
    const CircleView view(element_, receiver_.position);
    const double orientation = element_.Orientation();
    // Which side each end shows. Arcs that share an end share these bits, so that no silhouette falls between them.
    const bool convex_a = ShowsConvexSide(element_.a, element_.radial_a);
    const bool convex_b = ShowsConvexSide(element_.b, element_.radial_b);
    const Edge a = EndEdge(view, element_.a, element_.radial_a, -orientation);
    const Edge b = EndEdge(view, element_.b, element_.radial_b, orientation);
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

  // Of an end of the element.
  Edge OwnEnd(Point2 end) const {
    Edge vertex = VertexEdge(receiver_, end);
    if (IsJointOfChain(end)) vertex.element = id_;
    return vertex;
  }

  // Whether the Bézier that the element follows goes on at the end. Then light ends there because the curve touches the
  // direction, and at its own touching point beside the joint of elements.
  bool IsJointOfChain(Point2 end) const {
    const BezierPiece* const on = scene_.bezier_piece(element_);
    if (on == nullptr) return false;
    const Curve& curve = scene_.curve(element_.curve);
    const auto e = static_cast<std::uint32_t>(id_) + (end == element_.a ? 0xffffffffU : 1U);
    if (e < curve.first_element || e >= curve.first_element + curve.element_count) return false;
    const BezierPiece* const beside = scene_.bezier_piece(scene_.elements()[e]);
    return beside != nullptr && beside->bezier == on->bezier && !scene_.beziers()[on->bezier].IsStraight();
  }

  bool ShowsConvexSide(Point2 end, Vector2 radial) const {
    const double height = Dot(receiver_.position - end, radial);
    if (std::abs(height) > 2 * scene_.coordinate_error()) return height > 0;
    // On the tangent at the end: what counts is where the receiver moves.
    return Dot(receiver_.tangent, radial) > 0;
  }

  // The edge of an end. Where the circle goes on beyond it and the touching point is so near that their directions
  // agree, light ends at the touching point, which moves in another way.
  Edge EndEdge(const CircleView& view, Point2 end, Vector2 radial, double side) const {
    const Edge vertex = OwnEnd(end);
    if (!(view.f > 0) || !GoesOnBeyond(end, radial)) return vertex;
    const double near = 8 * kUnitRoundoff + 4 * scene_.coordinate_error() * vertex.q;
    // Before the end, as a rule; or a little beyond it, on the piece that begins there.
    for (const double at : {side, -side}) {
      const Edge silhouette = Silhouette(view, at);
      const double aside = silhouette.tangent * vertex.normal - silhouette.normal * vertex.tangent;
      if (std::abs(aside) * silhouette.q * vertex.q <= near && std::abs(silhouette.q - vertex.q) <= 1e-6 * vertex.q)
        return silhouette;
    }
    return vertex;
  }

  // Whether another arc of the same circle, or of the same Bézier bent to the same side, meets this one at the end in
  // that direction.
  bool GoesOnBeyond(Point2 end, Vector2 radial) const {
    const Curve& curve = scene_.curve(element_.curve);
    if (const BezierPiece* const on = scene_.bezier_piece(element_)) {
      const bool at_a = end == element_.a;
      const auto e = static_cast<std::uint32_t>(id_) + (at_a ? 0xffffffffU : 1U);
      if (e < curve.first_element || e >= curve.first_element + curve.element_count) return false;
      const Element& other = scene_.elements()[e];
      const BezierPiece* const beside = scene_.bezier_piece(other);
      return beside != nullptr && other.kind == Element::Kind::kArc && beside->bezier == on->bezier &&
             (at_a ? other.b : other.a) == end && (at_a ? other.radial_b : other.radial_a) == radial;
    }
    for (std::uint32_t e = curve.first_element; e < curve.first_element + curve.element_count; ++e) {
      const Element& other = scene_.elements()[e];
      if (static_cast<ElementId>(e) != id_ && other.carrier == element_.carrier &&
          (other.radial_a == radial || other.radial_b == radial)) {
        return true;
      }
    }
    return false;
  }

  // The touching point counter-clockwise (side +1) or clockwise (-1) of the circle's nearest point.
  Edge Silhouette(const CircleView& view, double side) const {
    const double root = std::sqrt(std::max(0.0, 2 * view.f / element_.radius));
    const double squared = LengthSquared(view.v);
    const Vector2 direction = (-root * view.v + side * Left(view.v)) / squared;
    const Vector2 outward = (view.v + side * root * Left(view.v)) / squared;
    Edge edge = SilhouetteEdge(receiver_, element_.radius * root * direction, -element_.radius * outward);
    edge.element = id_;
    return edge;
  }

  bool Above(const Edge& edge) const {
    if (edge.kind == Edge::Kind::kHorizon) return true;
    const double reach = std::abs(edge.tangent) + std::abs(edge.normal);
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
    AddAbove(kind, first, last);
  }

  void AddAbove(Part::Kind kind, const Edge& first, const Edge& last) {
    if (first.kind == Edge::Kind::kHorizon && last.kind == Edge::Kind::kHorizon && first.s == last.s) return;
    parts_.part[parts_.count++] = {kind, id_, first, last};
  }

  // Where the way from an edge above the horizon to one below crosses it. Less than half a turn, so the straight way
  // tells.
  Edge Horizon(const Edge& above, const Edge& below) const {
    // Either may lie on the other side by the accuracy of the coordinates.
    const double height = std::max(0.0, above.normal), depth = std::max(0.0, -below.normal);
    const double share = height > 0 ? height / (height + depth) : 0;
    return HorizonEdge(above.tangent + share * (below.tangent - above.tangent) > 0 ? 1 : -1);
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
  if (part.touches && tangent < part.through * (std::abs(tangent) + normal)) return 0;
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
  CircleView view(element, receiver.position);
  if (part.touches) view.f = 0;
  const double b = Dot(direction, view.v);
  // Half the chord, in radii; from far away by its offset from the centre, in which nothing cancels.
  const double power = 2 * view.f / element.radius;
  const double offset = Cross(direction, view.v);
  const double root = std::sqrt(std::max(0.0, power > 1 ? (1 - offset) * (1 + offset) : b * b - power));
  if (part.kind == Part::Kind::kConvex) return 2 * view.f / (root - b);
  return b > 0 ? -2 * view.f / (b + root) : (root - b) * element.radius;
}

double DistanceDoubt(const Scene& scene, const Part& part, const Receiver& receiver, double tangent, double normal,
                     double distance) {
  // How far the ray is aside at the distance: by the slope; where the ray touches a circle, by the root.
  const Element& element = scene.element(part.element);
  const double aside = 16 * kUnitRoundoff * std::abs(distance) + 4 * scene.coordinate_error();
  const Vector2 direction = tangent * receiver.tangent + normal * receiver.normal;
  if (part.kind == Part::Kind::kStraight) {
    const Vector2 along = element.b - element.a;
    return aside * Length(along) / std::abs(Cross(direction, along));
  }
  const Vector2 radial = element.radial_a + ((receiver.position - element.a) + distance * direction) / element.radius;
  const double incidence = std::abs(Dot(direction, radial)) / Length(radial);
  return 2 * std::min(aside / incidence, std::sqrt(2 * aside * element.radius));
}

}  // namespace flatlight
