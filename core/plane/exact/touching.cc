// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/touching.h"

#include <algorithm>
#include <cmath>

#include "core/math/tolerances.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

// Above a circle that stands upright on the receiver light has no derivative: it begins as a square root. Stated are
// the derivatives so far on, with errors of their size.
constexpr double kRootOnward = 0x1p-40;

// Moved on by d, the receiver is at x + d t + k d^2/2 n: outside a circle through x, by d (t.u) + d^2/2 (1/r + k n.u),
// u the circle's outward normal at x. The receiver's place on the element cuts it in two pieces, of which each leaves x
// in a direction of its own. As d vanishes, what lies between the direction backward and that one is at distance 0.
class TouchingBuilder {
 public:
  TouchingBuilder(const Scene& scene, ElementId id, const Receiver& receiver)
      : scene_(scene), id_(id), element_(scene.element(id)), receiver_(receiver) {
    arc_ = element_.kind == Element::Kind::kArc;
    if (arc_) {
      outward_ = Normalized(element_.radial_a + (receiver.position - element_.a) / element_.radius);
      along_ = element_.Orientation() * Left(outward_);
    } else {
      along_ = Normalized(element_.b - element_.a);
      outward_ = Right(along_);
    }
    leaving_ = Dot(receiver.tangent, outward_);
    bend_ = (arc_ ? 1 / element_.radius : 0) + OwnCurvature() * Dot(receiver.normal, outward_);
    // The element goes no farther beyond the receiver's tangent than what touches: it is one.
    const double touch = scene.touch_distance() + scene.coordinate_error();
    tangent_ = leaving_ * leaving_ <= 2 * std::abs(bend_) * touch;
    outside_ = tangent_ ? bend_ > 0 : leaving_ > 0;
  }

  Parts Build() {
    AddPiece(element_.a, -along_, false);
    AddPiece(element_.b, along_, true);
    return parts_;
  }

 private:
  // Of the curve that the receiver lies on: a free point's own way is straight, yet it is on the curve's side that it
  // is.
  double OwnCurvature() const {
    if (receiver_.element == ElementId::kNone || receiver_.curvature != 0) return receiver_.curvature;
    const Element& own = scene_.element(receiver_.element);
    if (own.kind == Element::Kind::kSegment) return 0;
    return std::copysign(1 / own.radius, Dot(receiver_.normal, own.center - receiver_.position));
  }

  // From the receiver's place to an end.
  void AddPiece(Point2 end, Vector2 direction, bool forward) {
    if (Length(end - receiver_.position) <= scene_.touch_distance()) return;
    Edge vertex = VertexEdge(receiver_, end);
    const bool above = IsAbove(vertex);
    const double onward = Dot(direction, receiver_.tangent) > 0 ? 1 : -1;
    const bool rises = Dot(direction, receiver_.normal) > 0;
    const Part::Kind hollow = arc_ ? Part::Kind::kConcave : Part::Kind::kStraight;
    if (tangent_) {
      const double height =
          -Dot(receiver_.normal, outward_) * bend_;  // Over the receiver's way, its second derivative.
      if (height > 0 && onward > 0) {
        const Part::Kind kind = !arc_ ? Part::Kind::kStraight : outside_ ? Part::Kind::kConvex : Part::Kind::kConcave;
        Add(kind, HorizonEdge(-1), arc_ ? HorizonEdge(1) : vertex, forward, kWhole, -height);
      } else if (above) {
        Add(hollow, HorizonEdge(onward), vertex, forward);
      }
      return;
    }
    const double through = Key(direction), lean = -leaving_ * (arc_ ? 1 / element_.radius : 0);
    if (!arc_) {
      if (rises && above) Add(hollow, HorizonEdge(-1), vertex, forward, vertex.key, lean);
    } else if (outside_) {
      if (!rises) {
        if (above) Add(hollow, HorizonEdge(-1), vertex, forward);
        return;
      }
      const Edge touch = TouchEdge(direction);
      if (!forward) Add(hollow, touch, above ? vertex : HorizonEdge(-1), forward);
      Add(Part::Kind::kConvex, HorizonEdge(-1), touch, forward, through, lean);
      if (forward) Add(hollow, touch, above ? vertex : HorizonEdge(-1), forward);
    } else if (rises) {
      Add(hollow, HorizonEdge(-1), above ? vertex : HorizonEdge(1), forward, through, lean);
    } else if (above) {
      Add(hollow, HorizonEdge(1), vertex, forward);
    }
  }

  // `near`: the end on the receiver's side.
  void Add(Part::Kind kind, const Edge& near, const Edge& far, bool forward, double through = -1, double lean = 0) {
    Part& part = parts_.part[parts_.count++];
    part.kind = kind, part.element = id_;
    part.first = forward ? near : far, part.last = forward ? far : near;
    part.touches = true, part.through = through, part.lean = lean;
  }

  bool IsAbove(const Edge& vertex) const {
    // A chord of the circle.
    if (tangent_ && arc_) return Dot(receiver_.normal, outward_) < 0 && vertex.normal > 0;
    const double reach = std::abs(vertex.tangent) + std::abs(vertex.normal);
    return vertex.normal > 2 * scene_.coordinate_error() + 4 * kUnitRoundoff * reach;
  }

  double Key(Vector2 direction) const {
    const double tangent = Dot(direction, receiver_.tangent);
    return tangent / (std::abs(tangent) + std::abs(Dot(direction, receiver_.normal)));
  }

  Edge TouchEdge(Vector2 direction) const {
    const double away = std::sqrt(2 * element_.radius * kRootOnward * leaving_);
    Edge edge = SilhouetteEdge(receiver_, away * direction, -element_.radius * outward_);
    edge.kind = Edge::Kind::kTouch;
    edge.turn = 4 * kUnitRoundoff + 2 * scene_.touch_distance() / element_.radius;
    return edge;
  }

  static constexpr double kWhole = 2;  // Beyond every key: nearer than all that the receiver leaves at an angle.

  const Scene& scene_;
  const ElementId id_;
  const Element& element_;
  const Receiver& receiver_;
  bool arc_ = false;
  Vector2 outward_;
  Vector2 along_;  // From a to b.
  double leaving_ = 0;
  double bend_ = 0;
  bool tangent_ = false;
  bool outside_ = false;
  Parts parts_;
};

}  // namespace

bool TouchesReceiver(const Scene& scene, const Element& element, const Receiver& receiver) {
  return DistanceTo(element, receiver.position) <= scene.touch_distance();
}

Parts TouchingParts(const Scene& scene, ElementId id, const Receiver& receiver) {
  return TouchingBuilder(scene, id, receiver).Build();
}

}  // namespace flatlight
