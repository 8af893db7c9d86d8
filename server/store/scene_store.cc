// SPDX-License-Identifier: Apache-2.0
#include "server/store/scene_store.h"

#include "server/store/error.h"

namespace flatlight {

absl::Status NoSuchScene(const std::string& sha256) {
  return MakeError(absl::StatusCode::kNotFound, "SCENE_NOT_FOUND", "scenes/" + sha256 + " does not exist");
}

}  // namespace flatlight
