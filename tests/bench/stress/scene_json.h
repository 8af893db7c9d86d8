// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_TESTS_BENCH_STRESS_SCENE_JSON_H_
#define FLATLIGHT_TESTS_BENCH_STRESS_SCENE_JSON_H_

#include <string>

#include "core/scene/description.h"

namespace flatlight::stress {

// A scene file of that scene. Numbers read back to the same bits.
std::string SceneJson(const SceneDescription& scene);

}  // namespace flatlight::stress

#endif  // FLATLIGHT_TESTS_BENCH_STRESS_SCENE_JSON_H_
