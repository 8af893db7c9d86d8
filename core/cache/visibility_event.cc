// SPDX-License-Identifier: Apache-2.0
#include "core/cache/visibility_event.h"

#include <algorithm>
#include <cmath>

#include "core/cache/series_rest.h"

namespace flatlight {
namespace {

// The terms' sizes at a distance.
std::array<double, kRecordOrders> TermsOf(const VisibilityEvent& event, double distance) {
  std::array<double, kRecordOrders> terms{};
  double power = 1;
  for (std::size_t k = 0; k < kRecordOrders; ++k) {
    terms[k] = power * event.jump[k].MaxSize();
    power *= std::abs(distance) / static_cast<double>(k + 1);
  }
  return terms;
}

}  // namespace

std::size_t VisibilityEvent::OrdersOver(double distance) const {
  const std::array<double, kRecordOrders> terms = TermsOf(*this, distance);
  std::size_t orders = kRecordOrders;
  // The first that jumps is the event's own, however large.
  while (orders > 1 && terms[orders - 1] > *std::max_element(terms.begin(), terms.begin() + orders - 1) &&
         std::any_of(terms.begin(), terms.begin() + orders - 1, [](double term) { return term > 0; }))
    --orders;
  return orders;
}

Spectrum VisibilityEvent::Derivative(std::size_t order, double distance, std::size_t orders) const {
  Spectrum sum;
  for (std::size_t k = orders; k-- > order;) sum = jump[k] + (distance / static_cast<double>(k - order + 1)) * sum;
  return sum;
}

double VisibilityEvent::MostChange(double distance) const {
  const std::array<double, kRecordOrders> terms = TermsOf(*this, distance);
  return terms[0] + terms[1] + terms[2];
}

double VisibilityEvent::Rest(double distance) const {
  const std::array<double, kRecordOrders> terms = TermsOf(*this, distance);
  const std::size_t orders = OrdersOver(distance);
  if (orders < kRecordOrders) return terms[orders] / (1 - kMostRatio);
  const double last = terms[kRecordOrders - 1], one_before = terms[kRecordOrders - 2];
  const double ratio = SeriesRatio(one_before, last);
  return last * ratio / (1 - ratio);
}

std::span<const VisibilityEvent> EventsIn(std::span<const VisibilityEvent> events, double low, double high) {
  const auto beyond = [](double at, const VisibilityEvent& event) { return at < event.at; };
  const auto first = std::upper_bound(events.begin(), events.end(), low, beyond);
  const auto last = std::upper_bound(first, events.end(), high, beyond);
  return {first, last};
}

bool IsLastInPlace(std::span<const VisibilityEvent> events, const VisibilityEvent& event) {
  return &event == &events.back() || (&event + 1)->at > event.at;
}

}  // namespace flatlight
