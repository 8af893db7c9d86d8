// SPDX-License-Identifier: Apache-2.0
// Scenes of any size for benchmarks; the same count gives the same scene everywhere.
#ifndef FLATLIGHT_TESTS_BENCH_RANDOM_SCENES_H_
#define FLATLIGHT_TESTS_BENCH_RANDOM_SCENES_H_

#include <cstdint>
#include <memory>
#include <random>

#include "core/scene/description.h"
#include "core/scene/scene.h"

namespace flatlight {

// Numbers in [0, 1), equal on every platform (which the standard's distributions are not).
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : engine_(seed) {}
  double Next() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_;
};

// A floor one metre long with a probe, a lamp above it, and `count` segments scattered between them, so short (about
// 1 / sqrt(count)) that the share of light that passes depends little on their number. Requires count >= 1.
SceneDescription RandomSegments(int count, double reflectance, std::uint32_t probe_points);

// Ends the program if the scene cannot be built.
std::shared_ptr<const Scene> Built(const SceneDescription& description);

// Random segments, built.
std::shared_ptr<const Scene> BuiltRandomSegments(int count, double reflectance, std::uint32_t probe_points);

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_BENCH_RANDOM_SCENES_H_
