// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_CACHE_VISIBILITY_EVENT_H_
#define FLATLIGHT_CORE_CACHE_VISIBILITY_EVENT_H_

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "core/scene/spectrum.h"

namespace flatlight {

// Irradiance and so many derivatives less one.
inline constexpr std::size_t kRecordOrders = 5;

// A place on a track at which what is seen changes, and with it irradiance or one of its derivatives.
struct VisibilityEvent {
  double at = 0;
  // By how much irradiance and its derivatives jump there, to the next larger coordinate. Normalised units.
  std::array<Spectrum, kRecordOrders> jump;
  // Irradiance on its left, if all of it is known there: what extrapolation to there can be held against.
  std::optional<Spectrum> before;
  // Whether the jumps are those of all light, and their series tells what they change as far as to the next points:
  // then they can be taken off what lies beyond, which leaves a smoother function.
  bool known = false;

  // Of the series, how many leading jumps are of use at a distance: where what covers or uncovers is much nearer than
  // that, its terms grow, and the first few of them alone are taken off.
  std::size_t OrdersOver(double distance) const;
  // What that many jumps make of a derivative at a distance to the right, if positive, or to the left.
  Spectrum Derivative(std::size_t order, double distance, std::size_t orders) const;
  // The same of irradiance with as many as are of use.
  Spectrum Change(double distance) const { return Derivative(0, distance, OrdersOver(distance)); }
  // By how much what jumped moves irradiance at a distance at most, by its first two derivatives.
  double MostChange(double distance) const;
  // An estimate of what the jumps that are not known add to Change.
  double Rest(double distance) const;

  template <class Self, class Stream>
  static void State(Self& self, Stream& stream) {
    stream(self.at, self.jump, self.before, self.known);
  }
};

// Those in (low, high], of events in order: at an event itself its right side counts.
std::span<const VisibilityEvent> EventsIn(std::span<const VisibilityEvent> events, double low, double high);

// Of several events in one place the last one tells what is right of it. `event`: one of `events`, which are in order.
bool IsLastInPlace(std::span<const VisibilityEvent> events, const VisibilityEvent& event);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_CACHE_VISIBILITY_EVENT_H_
