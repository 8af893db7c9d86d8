// SPDX-License-Identifier: Apache-2.0
// Scenes and receivers for benchmarks of exact light; the same numbers give the same scene everywhere.
#ifndef FLATLIGHT_TESTS_BENCH_LIGHT_SCENES_H_
#define FLATLIGHT_TESTS_BENCH_LIGHT_SCENES_H_

#include <cstdint>

#include "core/scene/description.h"

namespace flatlight {

// Which curves shine: the lamp above alone, or all.
enum class Shining { kLamp, kAll };

// A floor and a lamp, one metre long and one apart, and between them `count` segments of that length, or arcs of half
// a turn as wide, of any direction. Probes: points on the floor, points on random segments, and free points of any
// direction; `points` of each.
SceneDescription ScatteredCurves(int count, double length, bool arcs, Shining shining, std::uint32_t points);

// A town of square houses, a street between any two, with a probe in the streets: nearly everything is hidden.
SceneDescription Town(int houses_a_side, std::uint32_t points);

// A passage that winds through `walls` rooms, each seen through a door from the next: what is far is hidden.
SceneDescription Passage(int rooms, std::uint32_t points);

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_BENCH_LIGHT_SCENES_H_
