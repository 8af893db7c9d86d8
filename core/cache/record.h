// SPDX-License-Identifier: Apache-2.0
// A place at which irradiance and its derivatives are known, to be extrapolated from.
#ifndef FLATLIGHT_CORE_CACHE_RECORD_H_
#define FLATLIGHT_CORE_CACHE_RECORD_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/cache/visibility_event.h"
#include "core/scene/spectrum.h"

namespace flatlight {

// What a record's place sees, for estimates of how fast irradiance changes. Normalised units.
struct Surroundings {
  // Its mean over the hemicircle, weighed by the cosine; absent unless error control asks for it.
  std::optional<double> inverse_distance;
  Spectrum radiometric;  // E'' by the motion of what is seen alone, as if nothing could be covered (J12).
  // The same for radiance 1/2 everywhere, which makes irradiance 1: what each piece of a curve adds to it, without
  // signs, for with them it vanishes in closed rooms (THEORY 17 A13).
  double geometric = 0;
  double turning = 0;  // Sum of |sin'' theta| over all directions where radiance jumps.

  template <class Self, class Stream>
  static void State(Self& self, Stream& stream) {
    stream(self.inverse_distance, self.radiometric, self.geometric, self.turning);
  }
};

// Coordinates along tracks (see Placement) and all else in normalised units.
struct CacheRecord {
  std::uint32_t track = 0;
  double at = 0;
  std::uint32_t wave = 0;  // In which it was made.
  // Irradiance and its derivatives along the track; so many of them are known.
  std::array<Spectrum, kRecordOrders> derivative;
  std::size_t known = 1;
  double noise = 0;  // Of the irradiance: a standard error, or what its sources are off by.
  // By how much the gradient may jump at any event, beside what the events tell: of light whose jumps are not known.
  double unknown_jump = 0;
  Surroundings surroundings;
  // The events of its track, in order; none if error control does not ask for them. They must outlive this.
  std::span<const VisibilityEvent> events;
  // Set by SetErrors: the estimated error of extrapolation over a distance d is the sum of growth[k] d^k, beyond an
  // event with what is not known of its jumps, relative to `scale`. If `goes_on`, the last two are terms of a series
  // and the rest of it is estimated from them.
  std::array<double, kRecordOrders> growth{};
  bool goes_on = false;
  double scale = 0;
  // If above 0, the error that counts at a place is relative to what is extrapolated there with `degree`, at least
  // this.
  double least = 0;
  std::size_t degree = 0;
  // The footprint: it counts at distances below these.
  double left_radius = 0, right_radius = 0;

  // All but the events.
  template <class Self, class Stream>
  static void State(Self& self, Stream& stream) {
    stream(self.track, self.at, self.wave, self.derivative, self.known, self.noise, self.unknown_jump,
           self.surroundings, self.growth, self.goes_on, self.scale, self.least, self.degree, self.left_radius,
           self.right_radius);
    stream.Require(self.known > 0 && self.known <= kRecordOrders && self.degree < kRecordOrders);
  }

  double Irradiance() const { return derivative[0].Max(); }
  // Distances to the nearest events whose jumps can't be taken off, where what it vouches for ends; infinite if there
  // are none. At an event itself its right side counts.
  double EventToLeft() const;
  double EventToRight() const;
  // Whether it is known what jumps at an event.
  bool Passes(const VisibilityEvent& event) const { return event.known && unknown_jump == 0; }
  // As if there were no events.
  double SmoothError(double distance) const;
  // The same, and at least what it takes to be off at the next event on that side, and at the farthest one on the way,
  // as it is seen to be there.
  double ErrorOfStretch(double place) const;
  double ErrorAt(double place) const;
  // The error that counts.
  double CostAt(double place) const;
};

// Irradiance at a place on the record's track by the Taylor polynomial of a degree, and the known jumps of the events
// between. Requires degree < known.
Spectrum Extrapolate(const CacheRecord& record, double place, std::size_t degree);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_CACHE_RECORD_H_
