// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_SCENES_SCENE_UPLOAD_H_
#define FLATLIGHT_CLIENT_CLI_SCENES_SCENE_UPLOAD_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/connection/connection.h"
#include "client/cli/scenes/scene_file.h"

namespace flatlight {

// 64 lower-case hexadecimal digits.
std::string Sha256Hex(const std::string& bytes);

// The scene as the server knows it, for requests: a file is uploaded by its hash, in chunks, as far as the server does
// not have it yet. Its mistakes are not looked for here. `probes`, if any, take the place of the scene's own.
absl::StatusOr<v1::SceneSource> ProvideScene(Connection& connection, const SceneArgument& scene,
                                             const std::vector<v1::Probe>& probes = {});

// Asks for every mistake of a scene that was provided.
absl::StatusOr<v1::ValidateSceneResponse> ValidateScene(Connection& connection, const v1::SceneSource& source);

// "scene.json: plane.curves[3].emission.radiance[0]: ...", a line each.
std::string DiagnosticLines(const SceneArgument& scene, const v1::ValidateSceneResponse& response);

// What the user is told when a request about a scene failed with `error`: all mistakes of the scene, if it has some;
// settings by the names of their options.
absl::Status ExplainSceneError(Connection& connection, const SceneArgument& scene, const v1::SceneSource& source,
                               const absl::Status& error);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_SCENES_SCENE_UPLOAD_H_
