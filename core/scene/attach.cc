// SPDX-License-Identifier: Apache-2.0
#include "core/scene/attach.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>

#include "core/math/tolerances.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

// Sine of the angle up to which two directions count as one, beside what the ends of an element are uncertain by.
constexpr double kParallel = 1e-13;

bool GoesOnAlong(const Element& element, const Receiver& receiver, double near) {
  return std::max(Dot(element.a - receiver.position, receiver.tangent),
                  Dot(element.b - receiver.position, receiver.tangent)) > near;
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
void Lift(const std::vector<const Element*>& elements, double near, Receiver& receiver) {
  const bool runs_along = std::any_of(elements.begin(), elements.end(), [&](const Element* element) {
    return DistanceTo(*element, receiver.position) <= near && RunsAlong(*element, receiver, receiver.normal, near);
  });
  const auto lifted = [&](double lift) { return receiver.position + lift * receiver.normal; };
  double lift = kLiftTouches * near;
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

void AttachReceivers(const std::vector<Element>& elements, double near, std::vector<Receiver*> receivers) {
  if (receivers.empty()) return;
  std::sort(receivers.begin(), receivers.end(),
            [](const Receiver* l, const Receiver* r) { return l->position.x < r->position.x; });
  // No receiver is moved farther.
  const double far = near + 4 * kFarthestOnward;
  std::vector<bool> touched(receivers.size(), false);
  std::vector<std::vector<const Element*>> beside(receivers.size());
  std::vector<Rank> rank(receivers.size());
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const Element& element = elements[e];
    // An arc bulges from its chord by less than its length.
    const double reach = far + (element.kind == Element::Kind::kArc ? element.length : 0);
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
    if (touched[i] && receivers[i]->element == ElementId::kNone) Lift(beside[i], near, *receivers[i]);
}

}  // namespace flatlight
