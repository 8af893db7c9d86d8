// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_TESTS_SUPPORT_RENDERING_TEST_SCENE_H_
#define FLATLIGHT_TESTS_SUPPORT_RENDERING_TEST_SCENE_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace flatlight::testing {

// A floor under a lamp; one probe on the floor for each number, with that many points.
SceneDescription FloorAndLampDescription(const std::vector<std::uint32_t>& counts);
std::shared_ptr<const Scene> FloorAndLamp(const std::vector<std::uint32_t>& counts);

}  // namespace flatlight::testing

#endif  // FLATLIGHT_TESTS_SUPPORT_RENDERING_TEST_SCENE_H_
