// SPDX-License-Identifier: Apache-2.0
#include "core/scene/attach.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

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

// What a lifted receiver still touches runs along its normal. It is moved on until it does not, past the other curves
// that meet there.
void MoveOnward(const std::vector<Element>& elements, double touch, std::vector<Receiver*> receivers) {
  for (double step = kOnwardTouches * touch; !receivers.empty() && step <= kFarthestOnward; step *= 2) {
    std::vector<Receiver*> touching;
    for (Receiver* receiver : receivers) {
      const bool touches = std::any_of(elements.begin(), elements.end(), [&](const Element& element) {
        return DistanceTo(element, receiver->position) <= touch;
      });
      if (!touches) continue;
      receiver->position = receiver->position + step * receiver->tangent;
      receiver->displaced += step;
      touching.push_back(receiver);
    }
    receivers = std::move(touching);
  }
}

}  // namespace

void AttachReceivers(const std::vector<Element>& elements, double near, std::vector<Receiver*> receivers) {
  if (receivers.empty()) return;
  std::sort(receivers.begin(), receivers.end(),
            [](const Receiver* l, const Receiver* r) { return l->position.x < r->position.x; });
  std::vector<bool> touched(receivers.size(), false);
  std::vector<Rank> rank(receivers.size());
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const Element& element = elements[e];
    // An arc bulges from its chord by less than its length.
    const double reach = near + (element.kind == Element::Kind::kArc ? element.length : 0);
    const double low = std::min(element.a.x, element.b.x) - reach;
    const double high = std::max(element.a.x, element.b.x) + reach;
    auto it = std::lower_bound(receivers.begin(), receivers.end(), low,
                               [](const Receiver* r, double x) { return r->position.x < x; });
    for (; it != receivers.end() && (*it)->position.x <= high; ++it) {
      Receiver& receiver = **it;
      const auto i = static_cast<std::size_t>(it - receivers.begin());
      if (DistanceTo(element, receiver.position) > near) continue;
      touched[i] = true;
      const double sine = std::abs(Cross(receiver.normal, FrontNormal(element, receiver.position)));
      if (!(sine <= kParallel + 4 * near / element.length)) continue;
      // A free point's own way is straight: it runs above what bends away from its normal, and below what bends to it.
      const double curvature = Curvature(element, receiver);
      const Rank own{GoesOnAlong(element, receiver, near), curvature <= 0, -std::abs(curvature)};
      if (receiver.element != ElementId::kNone && own <= rank[i]) continue;
      receiver.element = static_cast<ElementId>(e);
      rank[i] = own;
    }
  }
  std::vector<Receiver*> lifted;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    Receiver& receiver = *receivers[i];
    if (touched[i] && receiver.element == ElementId::kNone) {
      receiver.position = receiver.position + kLiftTouches * near * receiver.normal;
      receiver.displaced = kLiftTouches * near;
      lifted.push_back(&receiver);
    }
  }
  MoveOnward(elements, 0.5 * near, lifted);
}

}  // namespace flatlight
