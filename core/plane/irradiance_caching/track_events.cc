// SPDX-License-Identifier: Apache-2.0
#include "core/plane/irradiance_caching/track_events.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace flatlight {
namespace {

// Of the way between two places, to which an event is found.
constexpr double kPrecision = 0x1p-40;
// Events so near to each other count as one.
constexpr double kTogether = 1e-5;
constexpr int kMostBetween = 64;
// Of the irradiance, and of what its slope adds: more no term of a series changes it by to the next place, if it is of
// use.
constexpr double kMostTerm = 1;

// Whether the series of what jumps tells what lies beyond as far as to the next place. In a corner it does not.
// `irradiance`: beside the event; where light begins it is none yet.
bool IsOfUse(const std::array<Spectrum, kRecordOrders>& jump, double irradiance, double distance) {
  const double most = kMostTerm * (irradiance + distance * jump[1].MaxSize());
  double power = 1;
  for (std::size_t k = 0; k < kRecordOrders; ++k) {
    if (!(power * jump[k].MaxSize() <= most)) return false;
    power *= distance / static_cast<double>(k + 1);
  }
  return true;
}

}  // namespace

std::vector<VisibilityEvent> EventsBetween(Skyline& skyline, const Track& track, std::span<const double> places,
                                           const Cancellation& cancellation) {
  std::vector<VisibilityEvent> events;
  const auto look = [&](double at) {
    skyline.LookFrom(track.At(at));
    return skyline.Signature();
  };
  for (std::size_t i = 1; i < places.size() && !cancellation.cancelled(); ++i) {
    double from = places[i - 1];
    const double to = places[i], least = kPrecision * (to - from);
    if (!(from < to)) continue;
    std::uint64_t here = look(from);
    const std::uint64_t there = look(to);
    for (int count = 0; here != there && from < to && count < kMostBetween; ++count) {
      double near = from, far = to;
      while (far - near > least) {
        const double middle = 0.5 * (near + far);
        if (!(near < middle && middle < far)) break;
        (look(middle) == here ? near : far) = middle;
      }
      VisibilityEvent event;
      event.at = far;
      look(near);
      const std::array<Spectrum, kRecordOrders> before = skyline.Irradiance();
      here = look(far);
      const std::array<Spectrum, kRecordOrders> beyond = skyline.Irradiance();
      for (std::size_t k = 0; k < event.jump.size(); ++k) event.jump[k] = beyond[k] - before[k];
      if (skyline.knows_all()) event.before = before[0];
      event.known = skyline.knows_all() && IsOfUse(event.jump, std::max(before[0].Max(), beyond[0].Max()), to - from);
      if (!events.empty() && event.at - events.back().at <= kTogether * (to - places[i - 1])) {
        const double apart = events.back().at - event.at;
        for (std::size_t k = 0; k < event.jump.size(); ++k)
          events.back().jump[k] = events.back().jump[k] + event.Derivative(k, apart, event.jump.size());
        events.back().known = events.back().known && event.known;
      } else {
        events.push_back(event);
      }
      from = far;
    }
  }
  return events;
}

}  // namespace flatlight
