// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_SCENE_CALLS_H_
#define FLATLIGHT_SERVER_SERVICE_SCENE_CALLS_H_

#include "absl/status/statusor.h"
#include "flatlight/v1/scene_service.pb.h"
#include "server/service/backend.h"
#include "server/service/scene_source.h"

namespace flatlight {

// The calls of SceneService as plain functions.
absl::StatusOr<v1::UploadSceneResponse> UploadScene(Backend& backend, const Caller& caller,
                                                    const v1::UploadSceneRequest& request);
absl::StatusOr<v1::GetSceneResponse> GetScene(Backend& backend, const Caller& caller,
                                              const v1::GetSceneRequest& request);
absl::StatusOr<v1::ListScenesResponse> ListScenes(Backend& backend, const Caller& caller,
                                                  const v1::ListScenesRequest& request);
absl::StatusOr<v1::DeleteSceneResponse> DeleteScene(Backend& backend, const Caller& caller,
                                                    const v1::DeleteSceneRequest& request);
absl::StatusOr<v1::SceneInfo> ShareScene(Backend& backend, const Caller& caller, const v1::ShareSceneRequest& request);
absl::StatusOr<v1::SceneInfo> UnshareScene(Backend& backend, const Caller& caller,
                                           const v1::UnshareSceneRequest& request);
absl::StatusOr<v1::ValidateSceneResponse> ValidateScene(Backend& backend, const Caller& caller,
                                                        const v1::ValidateSceneRequest& request,
                                                        const Proceed& proceed);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_SCENE_CALLS_H_
