// SPDX-License-Identifier: Apache-2.0
#include "core/scene/attach.h"

#include <algorithm>
#include <cmath>

#include "core/math/tolerances.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

// Sine of the angle up to which two directions count as one.
constexpr double kParallel = 1e-13;

}  // namespace

void AttachReceivers(const std::vector<Element>& elements, double near, std::vector<Receiver*> receivers) {
  if (receivers.empty()) return;
  std::sort(receivers.begin(), receivers.end(),
            [](const Receiver* l, const Receiver* r) { return l->position.x < r->position.x; });
  std::vector<bool> touched(receivers.size(), false);
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
      if (receiver.element != ElementId::kNone || DistanceTo(element, receiver.position) > near) continue;
      touched[static_cast<std::size_t>(it - receivers.begin())] = true;
      if (std::abs(Cross(receiver.normal, FrontNormal(element, receiver.position))) < kParallel) {
        receiver.element = static_cast<ElementId>(e);
      }
    }
  }
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    Receiver& receiver = *receivers[i];
    if (touched[i] && receiver.element == ElementId::kNone) {
      receiver.position = receiver.position + kLiftDistance * receiver.normal;
    }
  }
}

}  // namespace flatlight
