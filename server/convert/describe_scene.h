// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_CONVERT_DESCRIBE_SCENE_H_
#define FLATLIGHT_SERVER_CONVERT_DESCRIBE_SCENE_H_

#include "core/scene/description.h"
#include "core/scene/diagnostic.h"
#include "flatlight/v1/scene.pb.h"

namespace flatlight {

// Copies a scene into the core's terms. Reports numbers, points and directions that are missing, and puts NaN in their
// place; what a description can leave out itself (a name, a shape, a material's kind) is left out for BuildScene to
// find.
SceneDescription DescribeScene(const v1::Scene& proto, Diagnostics& diagnostics);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_CONVERT_DESCRIBE_SCENE_H_
