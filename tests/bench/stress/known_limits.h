// SPDX-License-Identifier: Apache-2.0
// What is known to fail, and how often it may. What fails beside it, or more often, is news.
#ifndef FLATLIGHT_TESTS_BENCH_STRESS_KNOWN_LIMITS_H_
#define FLATLIGHT_TESTS_BENCH_STRESS_KNOWN_LIMITS_H_

#include <string>

namespace flatlight::stress {

struct KnownLimit {
  const char* family;
  const char* check;
  double share;  // Of the scenes; some 3 times what a long campaign finds.
  const char* reason;
};

// Nearly all of the closed form of direct light (core/plane/exact).
inline constexpr KnownLimit kKnownLimits[] = {
    {"tangents", "rays", 0.6, "a circle that touches the receiver is on neither side of it"},
    {"tangents", "sampling", 0.6, "a circle that touches the receiver is on neither side of it"},
    {"tangents", "similarity", 0.05, "a circle that touches the receiver is on neither side of it"},
    {"tangents", "order", 0.05, "a circle that touches the receiver is on neither side of it"},
    {"tangents", "oracle", 0.7,
     "where circles touch, the place of their crossing is known to few digits: no bound says so"},
    {"slivers", "oracle", 0.4,
     "where walls cross at a small angle, the place is known to few digits: no bound says so"},
    {"slivers", "rays", 0.02, "crossings at angles of 1e-7 are missed"},
    {"arcs", "rays", 0.03, "breaks beside the horizon of a receiver on a short arc"},
    {"arcs", "finite", 0.01, "breaks beside the horizon of a receiver on a short arc"},
    {"arcs", "order", 0.01, "circles that touch, to rounding"},
    {"arcs", "sampling", 0.02, "breaks beside the horizon of a receiver on a short arc"},
    {"cluster", "rays", 0.03, "circles of 1e-9 that cross; sines of a far and a very near end cancel"},
    {"cluster", "similarity", 0.02, "circles of 1e-9 that cross"},
    {"fan", "rays", 0.01, "a receiver where two curves cross, facing along one of them"},
    {"fan", "similarity", 0.01, "sines of a far and a very near end cancel"},
    {"corners", "rays", 0.01, "a receiver 1e-9 from a wall's end"},
    {"corners", "similarity", 0.03, "walls nearer than the touch distance: which is there depends on the place"},
    {"grid", "rays", 0.01, "sines of a far and a very near end cancel"},
    {"grid arcs", "rays", 0.02, "an arc that ends on the receiver; the part of a circle that an arc leaves out"},
    {"grid arcs", "sampling", 0.05, "an arc that ends on the receiver"},
    {"grid arcs", "finite", 0.01, "a bound below 0 where an arc passes through the receiver"},
    {"grid arcs", "grid moves", 0.01, "sines of a far and a very near end cancel"},
    {"closed arcs", "similarity", 0.01, "walls that meet to rounding leave slits"},
    {"slivers", "similarity", 0.01, "crossings at small angles"},
    {"slivers", "reversal", 0.01, "crossings at small angles"},
    {"grazing", "similarity", 0.04, "a lamp in line with the receiver fills its horizon; light at 1e-6 rad is lost"},
    {"junctions", "similarity", 0.03, "light at 1e-6 rad is lost"},
    {"overlaps", "similarity", 0.04, "a lamp in line with the receiver fills its horizon"},
};

inline double KnownShare(const std::string& family, const std::string& check) {
  for (const KnownLimit& limit : kKnownLimits)
    if (limit.family == family && limit.check == check) return limit.share;
  return 0;
}

}  // namespace flatlight::stress

#endif  // FLATLIGHT_TESTS_BENCH_STRESS_KNOWN_LIMITS_H_
