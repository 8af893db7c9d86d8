// SPDX-License-Identifier: Apache-2.0
// What is expected of a series of which the first terms are known.
#ifndef FLATLIGHT_CORE_CACHE_SERIES_REST_H_
#define FLATLIGHT_CORE_CACHE_SERIES_REST_H_

namespace flatlight {

// At which x log x, as light goes beside a corner that reflects, has the right rest at its end, x = 0.
inline constexpr double kMostRatio = 0.75;

// So many times the estimate an error at an event is no surprise.
inline constexpr double kAsExpected = 1.25;

// Of a term to the one before, in [0, kMostRatio], from the sizes of the last two that are known: a rest that goes on
// like that is the last one times ratio / (1 - ratio).
inline double SeriesRatio(double before, double last) {
  return last < kMostRatio * before ? last / before : kMostRatio;
}

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_CACHE_SERIES_REST_H_
