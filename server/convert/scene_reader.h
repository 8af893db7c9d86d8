// SPDX-License-Identifier: Apache-2.0
// The strict reader of scene files.
#ifndef FLATLIGHT_SERVER_CONVERT_SCENE_READER_H_
#define FLATLIGHT_SERVER_CONVERT_SCENE_READER_H_

#include <string_view>

#include "core/scene/diagnostic.h"
#include "flatlight/v1/scene.pb.h"

namespace flatlight {

// Deepest nesting of objects and arrays in a scene file.
inline constexpr int kMaxSceneDepth = 32;

// Reads the JSON form of v1::Scene. Every unknown, duplicate or null field and every value of a wrong type goes into
// `diagnostics` with its path; a syntax error ends the reading, is reported with line and column, and leaves the scene
// empty. Meaning (ranges, names) is not checked here: see SceneFromProto. Returns whether there was no mistake.
bool ReadSceneJson(std::string_view json, v1::Scene& scene, Diagnostics& diagnostics);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_CONVERT_SCENE_READER_H_
