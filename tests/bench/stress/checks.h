// SPDX-License-Identifier: Apache-2.0
// What must be true of every valid scene.
#ifndef FLATLIGHT_TESTS_BENCH_STRESS_CHECKS_H_
#define FLATLIGHT_TESTS_BENCH_STRESS_CHECKS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/description.h"
#include "tests/bench/stress/families.h"
#include "tests/bench/stress/tally.h"

namespace flatlight::stress {

// What is wrong, and where; absent if nothing is.
using Failure = std::optional<std::string>;

struct Check {
  std::string name;
  // A function of scene and seed. A scene that the check cannot judge passes.
  Failure (*run)(const SceneDescription& scene, std::uint64_t seed, Tally& tally);
  int every = 1;                   // Slow ones look at one scene in so many.
  Crowding most = Crowding::kFew;  // The most crowded scenes that it can look at.
};

// In the same order always.
const std::vector<Check>& Checks();

// By file. Rays and light:
Failure CheckBuilds(const SceneDescription& scene, std::uint64_t seed, Tally& tally);
Failure CheckFinite(const SceneDescription& scene, std::uint64_t seed, Tally& tally);
Failure CheckTree(const SceneDescription& scene, std::uint64_t seed, Tally& tally);
Failure CheckClosed(const SceneDescription& scene, std::uint64_t seed, Tally& tally);
Failure CheckAgainstRays(const SceneDescription& scene, std::uint64_t seed, Tally& tally);
Failure CheckAgainstOracle(const SceneDescription& scene, std::uint64_t seed, Tally& tally);
Failure CheckTriangles(const SceneDescription& scene, std::uint64_t seed, Tally& tally);
Failure CheckSampling(const SceneDescription& scene, std::uint64_t seed, Tally& tally);
Failure CheckVisibilitySkip(const SceneDescription& scene, std::uint64_t seed, Tally& tally);
// The same scene in another form:
Failure CheckPowersOfTwo(const SceneDescription& scene, std::uint64_t seed, Tally& tally);
Failure CheckGridMoves(const SceneDescription& scene, std::uint64_t seed, Tally& tally);
Failure CheckSimilarity(const SceneDescription& scene, std::uint64_t seed, Tally& tally);
Failure CheckOrder(const SceneDescription& scene, std::uint64_t seed, Tally& tally);
Failure CheckReversal(const SceneDescription& scene, std::uint64_t seed, Tally& tally);
Failure CheckLinearity(const SceneDescription& scene, std::uint64_t seed, Tally& tally);

}  // namespace flatlight::stress

#endif  // FLATLIGHT_TESTS_BENCH_STRESS_CHECKS_H_
