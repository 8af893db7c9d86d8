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

// All of the closed form of direct light (core/plane/exact), but for walls nearer than the touch distance. Where
// triangles and tree disagree, the triangles have been right.
inline constexpr KnownLimit kKnownLimits[] = {
    {"tangents", "rays", 0.6, "a circle that touches the receiver is on neither side of it"},
    {"tangents", "sampling", 0.6, "a circle that touches the receiver is on neither side of it"},
    {"tangents", "similarity", 0.03, "a circle that touches the receiver is on neither side of it"},
    {"tangents", "order", 0.02, "a circle that touches the receiver is on neither side of it"},
    {"tangents", "oracle", 0.7,
     "where circles touch, the place of their crossing is known to few digits: no bound says so"},
    {"slivers", "oracle", 0.3,
     "where walls cross at a small angle, the place is known to few digits: no bound says so"},
    {"slivers", "rays", 0.005, "crossings at angles of 1e-7 are missed"},
    {"slivers", "similarity", 0.005, "crossings at small angles"},
    {"nested", "oracle", 0.02,
     "where walls cross at a small angle, the place is known to few digits: no bound says so"},
    {"arcs", "rays", 0.015, "breaks beside the horizon of a receiver on a short arc"},
    {"cluster", "rays", 0.05, "distances that agree to 1e-11 count as equal, however small the curves are"},
    {"cluster", "similarity", 0.05, "distances that agree to 1e-11 count as equal, however small the curves are"},
    {"cluster", "order", 0.03, "distances that agree to 1e-11 count as equal, however small the curves are"},
    {"cluster", "reversal", 0.005, "distances that agree to 1e-11 count as equal, however small the curves are"},
    {"cluster", "oracle", 0.05, "distances that agree to 1e-11 count as equal, however small the curves are"},
    {"sizes", "rays", 0.005, "distances that agree to 1e-11 count as equal, however small the curves are"},
    {"sizes", "similarity", 0.004, "distances that agree to 1e-11 count as equal, however small the curves are"},
    {"sizes", "reversal", 0.001, "distances that agree to 1e-11 count as equal, however small the curves are"},
    {"cluster", "triangles", 0.001,
     "the tree: distances that agree to 1e-11 count as equal, however small the curves are"},
    {"corners", "triangles", 0.001, "the tree: distances that agree to 1e-11 count as equal"},
    {"fan", "triangles", 0.0005, "the tree: distances that agree to 1e-11 count as equal"},
    {"slivers", "triangles", 0.0002, "the tree: crossings at angles of 1e-7 are missed"},
    {"fan", "rays", 0.003, "a receiver where two curves cross, facing along one of them"},
    {"corners", "similarity", 0.02, "walls nearer than the touch distance: which is there depends on the place"},
    {"grid", "rays", 0.002, "sines of a far and a very near end cancel"},
    {"grid arcs", "rays", 0.006, "an arc that ends on the receiver; the part of a circle that an arc leaves out"},
    {"grid arcs", "sampling", 0.02, "an arc that ends on the receiver"},
    {"grid arcs", "grid moves", 0.002, "sines of a far and a very near end cancel"},
    {"grid arcs", "similarity", 0.004, "an arc that ends on the receiver"},
    {"closed arcs", "similarity", 0.015, "walls that meet to rounding leave slits"},
    {"closed arcs", "oracle", 0.02, "walls that meet to rounding leave slits"},
    {"grazing", "rays", 0.001, "light at 1e-6 rad is lost"},
    {"junctions", "similarity", 0.005, "light at 1e-6 rad is lost"},
    {"overlaps", "similarity", 0.002, "a wall in line with the receiver"},
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
