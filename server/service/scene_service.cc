// SPDX-License-Identifier: Apache-2.0
#include "server/service/scene_service.h"

#include "server/service/activity.h"
#include "server/service/call.h"
#include "server/service/scene_calls.h"
#include "server/service/scene_lane.h"
#include "server/service/webhook_calls.h"

namespace flatlight {
namespace {

constexpr auto kInlineLane = [](const auto&) { return Lane::kInline; };
constexpr auto kQuickLane = [](const auto&) { return Lane::kQuick; };

}  // namespace

grpc::ServerUnaryReactor* SceneService::UploadScene(Context* context, const Bytes* request, Bytes* response) {
  return Answer<v1::UploadSceneRequest>(backend_, context, request, response, kQuickLane,
                                        [this](const Caller& caller, const v1::UploadSceneRequest& r) {
                                          return flatlight::UploadScene(backend_, caller, r);
                                        });
}

grpc::ServerUnaryReactor* SceneService::GetScene(Context* context, const Bytes* request, Bytes* response) {
  const auto lane = [this](const Caller& caller, const v1::GetSceneRequest& r) {
    return LaneOf(caller, r.name(), backend_.scenes);
  };
  return Answer<v1::GetSceneRequest>(
      backend_, context, request, response, lane,
      [this](const Caller& caller, const v1::GetSceneRequest& r) { return flatlight::GetScene(backend_, caller, r); });
}

grpc::ServerUnaryReactor* SceneService::ListScenes(Context* context, const Bytes* request, Bytes* response) {
  return Answer<v1::ListScenesRequest>(backend_, context, request, response, kQuickLane,
                                       [this](const Caller& caller, const v1::ListScenesRequest& r) {
                                         return flatlight::ListScenes(backend_, caller, r);
                                       });
}

grpc::ServerUnaryReactor* SceneService::DeleteScene(Context* context, const Bytes* request, Bytes* response) {
  return Answer<v1::DeleteSceneRequest>(backend_, context, request, response, kQuickLane,
                                        [this](const Caller& caller, const v1::DeleteSceneRequest& r) {
                                          return flatlight::DeleteScene(backend_, caller, r);
                                        });
}

grpc::ServerUnaryReactor* SceneService::ShareScene(Context* context, const Bytes* request, Bytes* response) {
  return Answer<v1::ShareSceneRequest>(backend_, context, request, response, kQuickLane,
                                       [this](const Caller& caller, const v1::ShareSceneRequest& r) {
                                         return flatlight::ShareScene(backend_, caller, r);
                                       });
}

grpc::ServerUnaryReactor* SceneService::UnshareScene(Context* context, const Bytes* request, Bytes* response) {
  return Answer<v1::UnshareSceneRequest>(backend_, context, request, response, kQuickLane,
                                         [this](const Caller& caller, const v1::UnshareSceneRequest& r) {
                                           return flatlight::UnshareScene(backend_, caller, r);
                                         });
}

grpc::ServerUnaryReactor* SceneService::ValidateScene(Context* context, const Bytes* request, Bytes* response) {
  const auto lane = [this](const Caller& caller, const v1::ValidateSceneRequest& r) {
    return LaneOf(caller, r.scene(), backend_.scenes);
  };
  return Answer<v1::ValidateSceneRequest>(backend_, context, request, response, lane,
                                          [this, context](const Caller& caller, const v1::ValidateSceneRequest& r) {
                                            return flatlight::ValidateScene(backend_, caller, r,
                                                                            WhileWanted(backend_, *context));
                                          });
}

grpc::ServerUnaryReactor* ServerService::GetCapabilities(grpc::CallbackServerContext* context,
                                                         const grpc::ByteBuffer* request, grpc::ByteBuffer* response) {
  return Answer<v1::GetCapabilitiesRequest>(backend_, context, request, response, kInlineLane,
                                            [this](const Caller& caller, const v1::GetCapabilitiesRequest&) {
                                              return absl::StatusOr<grpc::ByteBuffer>(capabilities_.For(caller));
                                            });
}

grpc::ServerUnaryReactor* ServerService::GetActivity(grpc::CallbackServerContext* context,
                                                     const grpc::ByteBuffer* request, grpc::ByteBuffer* response) {
  return Answer<v1::GetActivityRequest>(backend_, context, request, response, kQuickLane,
                                        [this](const Caller& caller, const v1::GetActivityRequest& r) {
                                          return flatlight::GetActivity(backend_, caller, r);
                                        });
}

grpc::ServerUnaryReactor* ServerService::GetWebhookSecret(grpc::CallbackServerContext* context,
                                                          const grpc::ByteBuffer* request, grpc::ByteBuffer* response) {
  return Answer<v1::GetWebhookSecretRequest>(backend_, context, request, response, kQuickLane,
                                             [this](const Caller& caller, const v1::GetWebhookSecretRequest&) {
                                               return flatlight::GetWebhookSecret(backend_, caller);
                                             });
}

grpc::ServerUnaryReactor* ServerService::RotateWebhookSecret(grpc::CallbackServerContext* context,
                                                             const grpc::ByteBuffer* request,
                                                             grpc::ByteBuffer* response) {
  return Answer<v1::RotateWebhookSecretRequest>(backend_, context, request, response, kQuickLane,
                                                [this](const Caller& caller, const v1::RotateWebhookSecretRequest& r) {
                                                  return flatlight::RotateWebhookSecret(backend_, caller, r);
                                                });
}

}  // namespace flatlight
