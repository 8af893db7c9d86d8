// SPDX-License-Identifier: Apache-2.0
// What is known to fail, and how often it may. What fails beside it, or more often, is news.
#ifndef FLATLIGHT_TESTS_BENCH_STRESS_KNOWN_LIMITS_H_
#define FLATLIGHT_TESTS_BENCH_STRESS_KNOWN_LIMITS_H_

#include <algorithm>
#include <cmath>
#include <string>

namespace flatlight::stress {

struct KnownLimit {
  const char* family;
  const char* check;
  double share;  // Of the scenes: some twice what a long campaign finds.
  const char* reason;
};

// Of the closed form of direct light (core/plane/exact), but for `sampling`, which is that of the other side.
inline constexpr KnownLimit kKnownLimits[] = {
    {"corners", "similarity", 0.0003, "derivatives where walls meet at small angles, or rounding puts a point aside"},
    {"junctions", "similarity", 0.001,
     "points that rounding puts on another side of walls nearer than what they touch"},
    {"tangents", "similarity", 0.001, "points that rounding puts on another side of walls nearer than what they touch"},
    {"overlaps", "similarity", 0.001, "points that rounding puts on one or the other of two walls over one another"},
    {"slivers", "similarity", 0.001, "walls that meet at a small angle: derivatives are those of one or the other"},
    {"beziers", "similarity", 0.003, "derivatives where curves cross themselves or each other at small angles"},
    {"beziers", "reversal", 0.003, "derivatives where curves cross themselves or each other at small angles"},
    {"cluster", "similarity", 0.001, "derivatives where a crossing and an end are one place to rounding"},
    {"cluster", "reversal", 0.001, "derivatives at events of features of 1e-9, which the check does not see as events"},
    {"grid arcs", "similarity", 0.001, "derivatives where a wall ends on a circle that it touches"},
    {"grid arcs", "reversal", 0.001, "second derivatives where curves touch and end in one place"},
    {"closed arcs", "similarity", 0.003, "an arc and its chord that meet to rounding leave slits of up to 1e-12"},
    {"arcs", "rays", 0.0005, "arcs of 1e-11: which side is seen is below rounding"},
    {"slivers", "rays", 0.0005, "points in corners of 1e-3: rays start farther on, where they see 1e-8 more or less"},
    {"slivers", "sampling", 0.0001, "walls 5e-15 apart, 2e-6 from a point: which one is in front"},
    {"grazing", "rays", 0.0005, "light of 1e-22 at the horizon, where coordinates tell nothing"},
};

// Whether so many failures are no news. One of a kind that is known never is.
inline bool IsKnown(const std::string& family, const std::string& check, double failures, double scenes) {
  for (const KnownLimit& limit : kKnownLimits) {
    if (limit.family != family || limit.check != check) continue;
    // Chance adds to it, as its root.
    const double expected = limit.share * scenes;
    return failures <= std::max(1.0, expected + 2 * std::sqrt(expected));
  }
  return failures == 0;
}

}  // namespace flatlight::stress

#endif  // FLATLIGHT_TESTS_BENCH_STRESS_KNOWN_LIMITS_H_
