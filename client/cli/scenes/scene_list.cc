// SPDX-License-Identifier: Apache-2.0
#include "client/cli/scenes/scene_list.h"

namespace flatlight {

absl::StatusOr<v1::ListScenesResponse> ListScenes(Connection& connection) {
  v1::ListScenesResponse all;
  v1::ListScenesRequest request;
  request.set_page_size(1000);
  do {
    v1::ListScenesResponse response;
    const absl::Status status =
        connection.Call(connection.scenes(), &v1::SceneService::Stub::ListScenes, request, response);
    if (!status.ok()) return status;
    all.mutable_scenes()->MergeFrom(response.scenes());
    request.set_page_token(response.next_page_token());
  } while (!request.page_token().empty());
  return all;
}

}  // namespace flatlight
