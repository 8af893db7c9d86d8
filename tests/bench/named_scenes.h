// SPDX-License-Identifier: Apache-2.0
// The scenes that benchmarks of transport measure on: the gallery's, and generated ones.
#ifndef FLATLIGHT_TESTS_BENCH_NAMED_SCENES_H_
#define FLATLIGHT_TESTS_BENCH_NAMED_SCENES_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace flatlight {

struct NamedScene {
  std::string name;
  std::shared_ptr<const Scene> scene;
};

// Every scene of the gallery; each probe thinned out to at most `points` points.
std::vector<NamedScene> GalleryScenes(std::uint32_t points);

// A floor under lamps of mixed power and size, hung at all heights, every fourth with a shade below it.
std::shared_ptr<const Scene> ManyLamps(int lamps, double reflectance, std::uint32_t points);
// A street between houses with lit windows under a dim sky: polylines, occlusion everywhere.
std::shared_ptr<const Scene> City(int houses, double reflectance, std::uint32_t points);
// A row of rooms with a door between each and the next, a lamp in every one; the probe is in the first.
std::shared_ptr<const Scene> RowOfRooms(int rooms, std::uint32_t points);
// A room of many straight pieces, all in convex position, with a lamp as one of them. No arcs.
std::shared_ptr<const Scene> ConvexRoom(int pieces, double reflectance, std::uint32_t points);
// Black curves under a lamp that reflects but sees no light, beside lamps that are turned away.
std::shared_ptr<const Scene> TurnedLamps(std::uint32_t points);
// A room with a white floor, black walls, a lamp and a table.
std::shared_ptr<const Scene> HalfBlackRoom(std::uint32_t points);
// Curves that reflect, and no lamp.
std::shared_ptr<const Scene> NoLamp(std::uint32_t points);

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_BENCH_NAMED_SCENES_H_
