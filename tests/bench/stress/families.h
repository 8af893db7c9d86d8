// SPDX-License-Identifier: Apache-2.0
// Valid scenes without end, each family awkward in a way of its own.
#ifndef FLATLIGHT_TESTS_BENCH_STRESS_FAMILIES_H_
#define FLATLIGHT_TESTS_BENCH_STRESS_FAMILIES_H_

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/description.h"
#include "tests/bench/stress/random.h"

namespace flatlight::stress {

// How many curves the scenes of a family have: a few, hundreds, thousands.
enum class Crowding { kFew, kHundreds, kThousands };

struct Family {
  std::string name;  // Of its scenes too, which tells checks what they may expect.
  SceneDescription (*make)(Random&);
  Crowding crowding = Crowding::kFew;  // Of crowded ones fewer scenes are tried.
};

// In the same order always.
const std::vector<Family>& Families();

// The scene of that number, always the same one. Its name is the family's.
SceneDescription MakeScene(const Family& family, std::uint64_t seed, std::uint64_t number);

// What the name of a scene promises.
// All probes lie in rooms that no light can enter.
bool IsClosed(const SceneDescription& scene);
// Curves lie on one another, and which is there depends on their order.
bool HasOverlaps(const SceneDescription& scene);
// All coordinates are small multiples of 2^-10.
bool IsOnGrid(const SceneDescription& scene);

}  // namespace flatlight::stress

#endif  // FLATLIGHT_TESTS_BENCH_STRESS_FAMILIES_H_
