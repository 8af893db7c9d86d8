// SPDX-License-Identifier: Apache-2.0
#include "core/cache/record.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/cache/series_rest.h"
#include "core/math/check.h"

namespace flatlight {

double CacheRecord::EventToLeft() const {
  const std::span<const VisibilityEvent> left = EventsIn(events, -std::numeric_limits<double>::infinity(), at);
  const auto next = std::find_if_not(left.rbegin(), left.rend(), [&](const auto& event) { return Passes(event); });
  return next == left.rend() ? std::numeric_limits<double>::infinity() : at - next->at;
}

double CacheRecord::EventToRight() const {
  const std::span<const VisibilityEvent> right = EventsIn(events, at, std::numeric_limits<double>::infinity());
  const auto next = std::find_if_not(right.begin(), right.end(), [&](const auto& event) { return Passes(event); });
  return next == right.end() ? std::numeric_limits<double>::infinity() : next->at - at;
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
  const double ratio = SeriesRatio(before, apart);
  return error + last * ratio / (1 - ratio);
}

double CacheRecord::ErrorOfStretch(double place) const {
  const double distance = std::abs(place - at), smooth = SmoothError(distance);
  if (!goes_on || distance == 0) return smooth;
  const double infinity = std::numeric_limits<double>::infinity(), most = place > at ? EventToRight() : EventToLeft();
  double error = smooth;
  const auto hold = [&](const VisibilityEvent& event) {
    const double range = std::abs(event.at - at);
    if (!event.before || !IsLastInPlace(events, event) || range == 0 || range > most) return;
    const Spectrum truth = place > at && !Passes(event) ? *event.before : *event.before + event.jump[0];
    const double off = (Extrapolate(*this, event.at, degree) - truth).MaxSize();
    if (off <= kAsExpected * SmoothError(range) * scale) return;
    // Something happens on the way that no event tells, as where a shadow's edge on another curve comes into sight.
    error = scale > 0 ? std::max(error, std::min(distance / range, 1.0) * off / scale) : infinity;
  };
  // The next one on that side, and of those on the way the farthest.
  if (place > at) {
    const std::span<const VisibilityEvent> side = EventsIn(events, at, infinity), passed = EventsIn(events, at, place);
    if (!side.empty()) hold(side.front());
    if (passed.size() > 1) hold(passed.back());
  } else {
    const std::span<const VisibilityEvent> side = EventsIn(events, -infinity, at), passed = EventsIn(events, place, at);
    if (!side.empty()) hold(side.back());
    if (passed.size() > 1) hold(passed.front());
  }
  return error;
}

double CacheRecord::ErrorAt(double place) const {
  const double smooth = ErrorOfStretch(place);
  double jumps = 0;
  for (const VisibilityEvent& event : EventsIn(events, std::min(at, place), std::max(at, place))) {
    const double distance = std::abs(place - event.at);
    jumps += Passes(event) ? event.Rest(distance) : event.MostChange(distance) + unknown_jump * distance;
  }
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
  const double sign = place < record.at ? -1 : 1;
  for (const VisibilityEvent& event : EventsIn(record.events, std::min(record.at, place), std::max(record.at, place)))
    if (record.Passes(event)) sum = sum + sign * event.Change(place - event.at);
  return sum;
}

}  // namespace flatlight
