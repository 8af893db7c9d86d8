// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_CONVERT_SCENE_CONVERT_H_
#define FLATLIGHT_SERVER_CONVERT_SCENE_CONVERT_H_

#include <memory>

#include "core/scene/diagnostic.h"
#include "core/scene/scene.h"
#include "flatlight/v1/scene.pb.h"

namespace flatlight {

// Checks what only the proto form can tell (missing fields, unknown fields, unknown enum values) and then builds the
// scene, which checks the rest. Null if there is any mistake; all are in `diagnostics`.
std::shared_ptr<const Scene> SceneFromProto(const v1::Scene& proto, Diagnostics& diagnostics);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_CONVERT_SCENE_CONVERT_H_
