// SPDX-License-Identifier: Apache-2.0
// The same scene elsewhere, larger, turned, mirrored, or written down in another way.
#ifndef FLATLIGHT_TESTS_BENCH_STRESS_SIMILARITY_H_
#define FLATLIGHT_TESTS_BENCH_STRESS_SIMILARITY_H_

#include <cstdint>
#include <vector>

#include "core/math/vec.h"
#include "core/scene/description.h"

namespace flatlight::stress {

// First mirrored (x to -x), then turned, then scaled, then shifted.
struct Similarity {
  double scale = 1;
  double angle = 0;  // rad. Quarter turns are free of rounding if they are given so:
  int quarters = 0;  // Turns by pi/2 on top of angle.
  Vector2 shift;
  bool mirrored = false;

  Point2 operator()(Point2 p) const;
  Vector2 Turned(Vector2 v) const;  // Without the scale.
};

// Curves of a mirrored scene run the other way, so that fronts stay fronts; every gradient changes its sign. Probe
// points keep their order.
SceneDescription Moved(const SceneDescription& scene, const Similarity& similarity);

// Whether no point of that description is rounded. For turns by quarters and scales by powers of two.
bool IsExact(const SceneDescription& scene, const Similarity& similarity);

// How far the points of that description are rounded from where they should be, in its own units of length.
double RoundingOf(const SceneDescription& moved, const Similarity& similarity);

// The part of it that arcs have because their angles round, though points do not.
double RoundingOfArcs(const SceneDescription& scene);

// Curves in another order. Probes keep theirs.
SceneDescription Shuffled(const SceneDescription& scene, std::uint64_t seed);

// Curves that are dark or emit on both sides run the other way; probes on them change sides. `turned[p]` says whether
// the gradients of probe p change their sign.
SceneDescription Reversed(const SceneDescription& scene, std::vector<bool>& turned);

}  // namespace flatlight::stress

#endif  // FLATLIGHT_TESTS_BENCH_STRESS_SIMILARITY_H_
