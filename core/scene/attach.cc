// SPDX-License-Identifier: Apache-2.0
#include "core/scene/attach.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

void AttachReceivers(const std::vector<Element>& elements, double near, std::vector<Receiver*> receivers) {
  if (receivers.empty()) return;
  std::sort(receivers.begin(), receivers.end(),
            [](const Receiver* l, const Receiver* r) { return l->position.x < r->position.x; });
  std::vector<bool> touched(receivers.size(), false);
  std::vector<bool> goes_on(receivers.size(), false);
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
      if (receiver.element != ElementId::kNone && goes_on[i]) continue;
      if (DistanceTo(element, receiver.position) > near) continue;
      touched[i] = true;
      const double sine = std::abs(Cross(receiver.normal, FrontNormal(element, receiver.position)));
      if (!(sine <= kParallel + 4 * near / element.length)) continue;
      const bool continues = GoesOnAlong(element, receiver, near);
      if (receiver.element == ElementId::kNone || continues) receiver.element = static_cast<ElementId>(e);
      goes_on[i] = continues;
    }
  }
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    Receiver& receiver = *receivers[i];
    if (touched[i] && receiver.element == ElementId::kNone) {
      receiver.position = receiver.position + kLiftTouches * near * receiver.normal;
    }
  }
}

}  // namespace flatlight
