// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_CONVERT_SCENE_CONVERT_H_
#define FLATLIGHT_SERVER_CONVERT_SCENE_CONVERT_H_

#include <memory>
#include <string_view>

#include "core/scene/diagnostic.h"
#include "core/scene/scene.h"
#include "flatlight/v1/scene.pb.h"

namespace flatlight {

// Checks what only the proto form can tell (missing fields, unknown fields, unknown enum values) and then builds the
// scene, which checks the rest. Null if there is any mistake; all are in `diagnostics`.
// `diagnostics` may hold mistakes already, found when `proto` was read: then the result is null, and what is reported
// besides are mistakes of their own, not the consequences of those.
std::shared_ptr<const Scene> SceneFromProto(const v1::Scene& proto, Diagnostics& diagnostics);

// The whole way from a scene file: ReadSceneJson and SceneFromProto. `proto` receives what was read. Null if there is
// any mistake; all are in `diagnostics`, those of form and those of meaning.
std::shared_ptr<const Scene> SceneFromJson(std::string_view json, v1::Scene& proto, Diagnostics& diagnostics);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_CONVERT_SCENE_CONVERT_H_
