// SPDX-License-Identifier: Apache-2.0
// What is known to fail, and how often it may. What fails beside it, or more often, is news.
#ifndef FLATLIGHT_TESTS_BENCH_STRESS_KNOWN_LIMITS_H_
#define FLATLIGHT_TESTS_BENCH_STRESS_KNOWN_LIMITS_H_

#include <algorithm>
#include <string>

namespace flatlight::stress {

struct KnownLimit {
  const char* family;
  const char* check;
  double share;  // Of the scenes: some twice what a long campaign finds.
  const char* reason;
};

// All of the closed form of direct light (core/plane/exact).
inline constexpr KnownLimit kKnownLimits[] = {
    {"corners", "similarity", 0.012, "points that rounding puts on another side of walls nearer than what they touch"},
    {"junctions", "similarity", 0.004,
     "points that rounding puts on another side of walls nearer than what they touch"},
    {"tangents", "similarity", 0.004, "points that rounding puts on another side of walls nearer than what they touch"},
    {"fan", "similarity", 0.004, "free points on a wall that face along it, to 2e-3: seen from one side or the other"},
    {"slivers", "similarity", 0.004, "walls that meet at a small angle: derivatives are those of one or the other"},
    {"cluster", "similarity", 0.004, "derivatives where a crossing and an end are one place to rounding"},
    {"closed arcs", "similarity", 0.005, "an arc and its chord that meet to rounding leave slits of up to 1e-12"},
    {"closed arcs", "oracle", 0.02,
     "walls that meet to rounding leave slits: light of 1e-17 is left out, with a bound of 0"},
    {"arcs", "oracle", 0.05, "full circles close to rounding, for the oracle: light of 1e-15 comes through"},
    {"grazing", "rays", 0.002, "light of 1e-22 at the horizon, where coordinates tell nothing"},
};

// Whether so many failures are no news. One of a kind that is known never is.
inline bool IsKnown(const std::string& family, const std::string& check, double failures, double scenes) {
  for (const KnownLimit& limit : kKnownLimits) {
    if (limit.family == family && limit.check == check) return failures <= std::max(1.0, limit.share * scenes);
  }
  return failures == 0;
}

}  // namespace flatlight::stress

#endif  // FLATLIGHT_TESTS_BENCH_STRESS_KNOWN_LIMITS_H_
