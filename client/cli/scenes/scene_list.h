// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_SCENES_SCENE_LIST_H_
#define FLATLIGHT_CLIENT_CLI_SCENES_SCENE_LIST_H_

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/connection/connection.h"

namespace flatlight {

enum class WhoseScenes {
  kAll,    // The gallery, and the caller's own uploads; for graders and above those of all.
  kOwn,    // The caller's own uploads.
  kShared  // Those of others that are shared with the caller.
};
// Every one that the server keeps, the gallery first.
absl::StatusOr<v1::ListScenesResponse> ListScenes(Connection& connection, WhoseScenes whose = WhoseScenes::kAll);

// "scenes/{sha256}" of an upload, from that, from the hash, or from the beginning of one that only one of the scenes
// that the caller may see has; those are listed only if they are needed. Errors end with ExitCode::kUsage.
absl::StatusOr<std::string> ResolveUpload(Connection& connection, const std::string& text);

absl::StatusOr<v1::SceneInfo> ShareScene(Connection& connection, const std::string& name, const std::string& grantee,
                                         v1::Share::Access access);
absl::StatusOr<v1::SceneInfo> UnshareScene(Connection& connection, const std::string& name, const std::string& grantee);
absl::Status DeleteScene(Connection& connection, const std::string& name);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_SCENES_SCENE_LIST_H_
