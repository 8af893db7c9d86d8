// SPDX-License-Identifier: Apache-2.0
#include "core/scene/attach.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "core/math/tolerances.h"
#include "core/scene/bezier_chain.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

// Sine of the angle up to which two directions count as one, beside what the ends of an element are uncertain by.
constexpr double kParallel = 1e-13;

bool GoesOnAlong(const Element& element, const Receiver& receiver, double near) {
  return std::max(Dot(element.a - receiver.position, receiver.tangent),
                  Dot(element.b - receiver.position, receiver.tangent)) > near;
}

struct BezierPlace {
  Receiver receiver;  // In its place, with the curve's frame.
  bool is_along = false;
};

// Nothing if the curve does not pass through the receiver.
std::optional<BezierPlace> OnBezier(const Element& element, const BezierPiece& on, const Bezier& bezier, double near,
                                    const Receiver& receiver) {
  const double u = NearestOnBezier(bezier, receiver.position, on.from, on.to, 0.5 * (on.from + on.to));
  if (Length(bezier.At(u) - receiver.position) > near) return std::nullopt;
  BezierPlace place;
  PlaceOnBezier(element, bezier, u, 1, place.receiver);
  place.is_along = std::abs(Cross(receiver.normal, place.receiver.normal)) <= kParallel + 4 * near / element.length;
  return place;
}

// Of an element that a receiver may lie on: whether it goes on along the tangent, whether it is straight or bends away
// from the normal, and how little it bends.
using Rank = std::tuple<bool, bool, double>;

// Toward the receiver's normal.
double Curvature(const Element& element, const Receiver& receiver) {
  if (element.kind == Element::Kind::kSegment) return 0;
  return std::copysign(1 / element.radius, Dot(receiver.normal, element.center - receiver.position));
}

bool RunsAlong(const Element& element, const Receiver& receiver, Vector2 direction, double near) {
  const double sine = std::abs(Dot(direction, FrontNormal(element, receiver.position)));
  return sine <= kParallel + 4 * near / element.length;
}

double Clearance(const std::vector<const Element*>& elements, Point2 position) {
  double clearance = std::numeric_limits<double>::infinity();
  for (const Element* element : elements) clearance = std::min(clearance, DistanceTo(*element, position));
  return clearance;
}

// Off the curves that meet there, toward the normal: so far that each of them, at however small an angle to the normal,
// is on the side that the normal tells.
void Lift(const std::vector<const Element*>& elements, double near, double least, Receiver& receiver) {
  const bool runs_along = std::any_of(elements.begin(), elements.end(), [&](const Element* element) {
    return DistanceTo(*element, receiver.position) <= near && RunsAlong(*element, receiver, receiver.normal, near);
  });
  const auto lifted = [&](double lift) { return receiver.position + lift * receiver.normal; };
  double lift = std::max(kLiftTouches * near, least);
  while (!runs_along && 2 * lift <= kFarthestOnward && Clearance(elements, lifted(lift)) <= 2 * near) lift *= 2;
  receiver.position = lifted(lift);
  receiver.displaced = lift;
  // What it still touches runs along the normal: on past all curves that meet there.
  for (double step = 0.5 * kOnwardTouches * near;
       step <= kFarthestOnward && Clearance(elements, receiver.position) <= 0.5 * near; step *= 2) {
    receiver.position = receiver.position + step * receiver.tangent;
    receiver.displaced += step;
  }
}

}  // namespace

void AttachReceivers(const Scene& scene, double near, std::vector<Receiver*> receivers) {
  if (receivers.empty()) return;
  const std::vector<Element>& elements = scene.elements();
  for (Receiver* receiver : receivers)
    receiver->position = receiver->position + receiver->offset, receiver->offset = {};
  std::sort(receivers.begin(), receivers.end(),
            [](const Receiver* l, const Receiver* r) { return l->position.x < r->position.x; });
  // No receiver is moved farther.
  const double far = near + 4 * kFarthestOnward;
  std::vector<bool> touched(receivers.size(), false);
  std::vector<std::vector<const Element*>> beside(receivers.size());
  std::vector<double> least(receivers.size(), 0);  // Lifts.
  // Those on Béziers, and where: not moved while the list must stay in order.
  std::vector<std::pair<Receiver*, Receiver>> attached;
  std::vector<Rank> rank(receivers.size());
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const Element& element = elements[e];
    const BezierPiece* const on = scene.bezier_piece(element);
    const bool follows = on != nullptr && on->bends;
    // An arc bulges from its chord by less than its length.
    const double reach =
        far + (follows ? on->distance : 0) + (element.kind == Element::Kind::kArc ? element.length : 0);
    const double low = std::min(element.a.x, element.b.x) - reach;
    const double high = std::max(element.a.x, element.b.x) + reach;
    auto it = std::lower_bound(receivers.begin(), receivers.end(), low,
                               [](const Receiver* r, double x) { return r->position.x < x; });
    for (; it != receivers.end() && (*it)->position.x <= high; ++it) {
      Receiver& receiver = **it;
      const auto i = static_cast<std::size_t>(it - receivers.begin());
      const double distance = DistanceTo(element, receiver.position);
      if (distance > far) continue;
      beside[i].push_back(&element);
      if (follows) {
        if (distance > near + on->distance) continue;
        const std::optional<BezierPlace> place = OnBezier(element, *on, scene.beziers()[on->bezier], near, receiver);
        if (!place) continue;
        touched[i] = true;
        // As far off the curve and the arcs, however it is turned.
        const double upright = std::max(std::abs(Dot(receiver.normal, place->receiver.normal)), 1e-3);
        least[i] = std::max(least[i], 4 * (on->distance + near) / upright);
        const Rank own{GoesOnAlong(element, receiver, near), true, 0};
        if (!place->is_along || (receiver.element != ElementId::kNone && own <= rank[i])) continue;
        receiver.element = static_cast<ElementId>(e);
        rank[i] = own;
        attached.emplace_back(&receiver, place->receiver);
        continue;
      }
      if (distance > near) continue;
      touched[i] = true;
      if (!RunsAlong(element, receiver, receiver.tangent, near)) continue;
      // A free point's own way is straight: it runs above what bends away from its normal, and below what bends to it.
      const double curvature = Curvature(element, receiver);
      const Rank own{GoesOnAlong(element, receiver, near), curvature <= 0, -std::abs(curvature)};
      if (receiver.element != ElementId::kNone && own <= rank[i]) continue;
      receiver.element = static_cast<ElementId>(e);
      rank[i] = own;
    }
  }
  for (std::size_t i = 0; i < receivers.size(); ++i)
    if (touched[i] && receivers[i]->element == ElementId::kNone) Lift(beside[i], near, least[i], *receivers[i]);
  for (const auto& [receiver, placed] : attached)
    if (scene.bezier_piece(scene.element(receiver->element)) != nullptr)
      receiver->position = placed.position, receiver->offset = placed.offset;
}

}  // namespace flatlight
