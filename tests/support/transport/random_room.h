// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_TESTS_SUPPORT_TRANSPORT_RANDOM_ROOM_H_
#define FLATLIGHT_TESTS_SUPPORT_TRANSPORT_RANDOM_ROOM_H_

#include <cstdint>
#include <memory>

#include "core/scene/scene.h"

namespace flatlight {

// Grey rooms, closed or open to the sky, with a lamp, three straight and round things, and a light without a surface in
// every third; every fourth reflects up to 0.97, the others up to 0.8. 34 probe points, times `times`.
std::shared_ptr<const Scene> RandomRoom(std::uint64_t seed, std::uint32_t times = 1);

// Rooms that are hard to solve, grey: walls that meet at angles down to 3 degrees, round walls, gaps down to a
// millionth of the room, things that stand on a wall or cross, black and nearly white ones side by side (up to 0.9999),
// lamps far smaller than the room, lights without a surface, a sky. 40 probe points, times `times`.
std::shared_ptr<const Scene> HardRoom(std::uint64_t seed, std::uint32_t times = 1);

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_SUPPORT_TRANSPORT_RANDOM_ROOM_H_
