// SPDX-License-Identifier: Apache-2.0
#include "core/cache/record.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "core/math/check.h"

namespace flatlight {
namespace {

// At which x log x has the right rest at its end, x = 0.
constexpr double kMostRatio = 0.75;

// So many times the estimate an error at an event is no surprise.
constexpr double kAsExpected = 1.25;

using Event = std::span<const VisibilityEvent>::iterator;

// The first one to the right of a place.
Event Beyond(std::span<const VisibilityEvent> events, double place) {
  return std::upper_bound(events.begin(), events.end(), place,
                          [](double at, const VisibilityEvent& event) { return at < event.at; });
}

// By how much what jumped moves irradiance at a distance from there.
double JumpAt(const VisibilityEvent& event, double distance) {
  return event.jump[0].MaxSize() + distance * (event.jump[1].MaxSize() + 0.5 * distance * event.jump[2].MaxSize());
}

}  // namespace

double CacheRecord::EventToLeft() const {
  const Event next = Beyond(events, at);
  return next == events.begin() ? std::numeric_limits<double>::infinity() : at - std::prev(next)->at;
}

double CacheRecord::EventToRight() const {
  const Event next = Beyond(events, at);
  return next == events.end() ? std::numeric_limits<double>::infinity() : next->at - at;
}

double CacheRecord::SmoothError(double distance) const {
  double error = 0;
  for (std::size_t k = kRecordOrders; k-- > 0;) error = error * distance + growth[k];
  if (!goes_on || degree + 2 >= kRecordOrders || growth[degree + 2] == 0) return error;
  // Beside a corner where light is reflected irradiance goes like x log x, whose terms in d/x have the factors
  // 1/(k (k - 1)): from the ratio of two the ratio far along the series follows, d/x.
  const double before = growth[degree + 1];
  double last = growth[degree + 2];
  for (std::size_t k = 0; k < degree + 2; ++k) last *= distance;
  const double factor = static_cast<double>(degree + 2) / static_cast<double>(std::max<std::size_t>(degree, 1));
  const double apart = factor * growth[degree + 2] * distance;
  const double ratio = apart < kMostRatio * before ? apart / before : kMostRatio;
  return error + last * ratio / (1 - ratio);
}

double CacheRecord::ErrorOfStretch(double place) const {
  const double distance = std::abs(place - at), smooth = SmoothError(distance);
  if (!goes_on || distance == 0) return smooth;
  const Event right = Beyond(events, at);
  if (place > at ? right == events.end() : right == events.begin()) return smooth;
  const VisibilityEvent& event = place > at ? *right : *std::prev(right);
  const double range = std::abs(event.at - at);
  if (!event.before || range == 0) return smooth;
  const Spectrum truth = place > at ? *event.before : *event.before + event.jump[0];
  const double off = (Extrapolate(*this, event.at, degree) - truth).MaxSize();
  if (off <= kAsExpected * SmoothError(range) * scale) return smooth;
  if (!(scale > 0)) return std::numeric_limits<double>::infinity();
  // Something happens on the way that no event tells, as where a shadow's edge on another curve comes into sight.
  return std::max(smooth, std::min(distance / range, 1.0) * off / scale);
}

double CacheRecord::ErrorAt(double place) const {
  const double smooth = ErrorOfStretch(place);
  double jumps = 0;
  const Event here = Beyond(events, at), there = Beyond(events, place);
  for (Event event = std::min(here, there); event != std::max(here, there); ++event)
    jumps += JumpAt(*event, std::abs(place - event->at)) + unknown_jump * std::abs(place - event->at);
  // Where there is no light nothing is known of how much there could be.
  return jumps == 0 ? smooth : scale > 0 ? smooth + jumps / scale : std::numeric_limits<double>::infinity();
}

double CacheRecord::CostAt(double place) const {
  const double error = ErrorAt(place);
  if (!(least > 0)) return error;
  return error * scale / std::max(Extrapolate(*this, place, degree).Max(), least);
}

Spectrum Extrapolate(const CacheRecord& record, double place, std::size_t degree) {
  FLATLIGHT_DCHECK(degree < record.known);
  const double distance = place - record.at;
  Spectrum sum = record.derivative[degree];
  for (std::size_t k = degree; k-- > 0;) sum = record.derivative[k] + (distance / static_cast<double>(k + 1)) * sum;
  return sum;
}

}  // namespace flatlight
