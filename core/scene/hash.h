// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_SCENE_HASH_H_
#define FLATLIGHT_CORE_SCENE_HASH_H_

#include <string>

#include "core/scene/description.h"

namespace flatlight {

// SHA-256, 64 hexadecimal digits. Equal for descriptions that mean the same world, or the same probes, in the same
// order, whatever names they use. The description must be valid.
std::string HashWorld(const SceneDescription& description);
std::string HashProbes(const SceneDescription& description);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_SCENE_HASH_H_
