// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/meeting.h"

#include <algorithm>
#include <cmath>

#include "core/math/tolerances.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

Vector2 BendAt(const Element& element, Vector2 front) {
  if (element.kind == Element::Kind::kSegment) return {};
  return element.Orientation() / element.radius * front;
}

// How far an element is from what it stands for.
double BezierDistance(const Scene& scene, const Element& element) {
  const BezierPiece* const on = scene.bezier_piece(element);
  return on == nullptr ? 0 : on->distance;
}

}  // namespace

void AddMeetingError(const Scene& scene, const Receiver& receiver, const Element& e, const Element& f, Edge& edge) {
  const double apart = 4 * scene.coordinate_error() + BezierDistance(scene, e) + BezierDistance(scene, f);
  const Vector2 front_e = FrontNormal(e, edge.point), front_f = FrontNormal(f, edge.point);
  const double sine = std::abs(Cross(front_e, front_f));
  const double bend = Length(BendAt(e, front_e) - BendAt(f, front_f));
  double moves = std::min({e.length, f.length, sine > 0 ? apart / sine : 1});
  if (bend > 0) moves = std::min(moves, 2 * std::sqrt(apart / bend));
  if (!(moves > apart)) return;
  const Vector2 toward = edge.s * receiver.tangent + edge.c * receiver.normal;
  // Across the line of sight by the curve's slope to it, and by its bulge.
  const double slope = std::abs(Dot(toward, front_e)) + 0.5 * moves * Length(BendAt(e, front_e));
  edge.turn += std::min(1.0, slope) * moves * edge.q;
  edge.stretch += moves * edge.q;
}

bool MayLieBetween(const Edge& edge, double low, double high) {
  const double turn = 2 * edge.turn + 8 * kUnitRoundoff;
  if (turn > 0.1) return true;
  // Beyond the horizon keys don't go on.
  if (edge.c < -turn) return false;
  const double key = edge.c > 0 ? edge.key : std::copysign(1.0, edge.s);
  return key >= low - turn && key <= high + turn;
}

Tangencies FindTangencies(const Scene& scene, const Element& e, const Element& f) {
  Tangencies found;
  if (e.carrier == f.carrier) return found;
  const Element& arc = e.kind == Element::Kind::kArc ? e : f;
  const Element& other = e.kind == Element::Kind::kArc ? f : e;
  if (arc.kind != Element::Kind::kArc) return found;
  // On the line through the centres, or on the perpendicular of the segment.
  const double near = 8 * scene.coordinate_error();
  Vector2 toward;
  if (other.kind == Element::Kind::kArc) {
    toward = other.center - arc.center;
    const double apart = Length(toward), sum = arc.radius + other.radius;
    if (apart == 0 || std::min(std::abs(apart - sum), std::abs(apart - std::abs(arc.radius - other.radius))) >
                          near + 4 * kUnitRoundoff * sum)
      return found;
    toward = toward / apart;
  } else {
    const Vector2 along = Normalized(other.b - other.a);
    const double side = Cross(along, arc.center - other.a);
    if (std::abs(std::abs(side) - arc.radius) > near + 4 * kUnitRoundoff * arc.radius) return found;
    toward = Left(along);
  }
  for (const double side : {-1.0, 1.0}) {
    const Point2 place = arc.center + side * arc.radius * toward;
    if (DistanceTo(e, place) <= near && DistanceTo(f, place) <= near) found.place[found.count++] = place;
  }
  return found;
}

bool ShareEnd(const Element& e, const Element& f, Point2 point) {
  return (e.a == point || e.b == point) && (f.a == point || f.b == point);
}

bool FollowOneBend(const Scene& scene, const Element& e, const Element& f) {
  const BezierPiece *const first = scene.bezier_piece(e), *const second = scene.bezier_piece(f);
  if (first == nullptr || second == nullptr || first->bezier != second->bezier) return false;
  return first->run == second->run || e.b == f.a || f.b == e.a;
}

}  // namespace flatlight
