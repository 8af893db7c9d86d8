// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_SCENES_SCENE_LIST_H_
#define FLATLIGHT_CLIENT_CLI_SCENES_SCENE_LIST_H_

#include "absl/status/statusor.h"
#include "client/cli/connection/connection.h"

namespace flatlight {

// All scenes of the server, the gallery first.
absl::StatusOr<v1::ListScenesResponse> ListScenes(Connection& connection);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_SCENES_SCENE_LIST_H_
