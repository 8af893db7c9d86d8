// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_SCENE_SERVICE_H_
#define FLATLIGHT_SERVER_SERVICE_SCENE_SERVICE_H_

#include "flatlight/v1/scene_service.grpc.pb.h"
#include "flatlight/v1/server_service.grpc.pb.h"
#include "server/service/backend.h"
#include "server/service/capabilities.h"

namespace flatlight {

using RawSceneService =
    v1::SceneService::WithRawCallbackMethod_UploadScene<v1::SceneService::WithRawCallbackMethod_GetScene<
        v1::SceneService::WithRawCallbackMethod_ListScenes<v1::SceneService::WithRawCallbackMethod_DeleteScene<
            v1::SceneService::WithRawCallbackMethod_ShareScene<v1::SceneService::WithRawCallbackMethod_UnshareScene<
                v1::SceneService::WithRawCallbackMethod_ValidateScene<v1::SceneService::Service>>>>>>>;

// gRPC's side of SceneService; the calls themselves are in scene_calls.h.
class SceneService final : public RawSceneService {
 public:
  explicit SceneService(Backend& backend) : backend_(backend) {}

  using Context = grpc::CallbackServerContext;
  using Bytes = grpc::ByteBuffer;
  grpc::ServerUnaryReactor* UploadScene(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* GetScene(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* ListScenes(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* DeleteScene(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* ShareScene(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* UnshareScene(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* ValidateScene(Context* context, const Bytes* request, Bytes* response) override;

 private:
  Backend& backend_;
};

class ServerService final
    : public v1::ServerService::WithRawCallbackMethod_GetCapabilities<
          v1::ServerService::WithRawCallbackMethod_GetActivity<
              v1::ServerService::WithRawCallbackMethod_GetWebhookSecret<
                  v1::ServerService::WithRawCallbackMethod_RotateWebhookSecret<v1::ServerService::Service>>>> {
 public:
  explicit ServerService(Backend& backend) : backend_(backend), capabilities_(backend) {}

  grpc::ServerUnaryReactor* GetCapabilities(grpc::CallbackServerContext* context, const grpc::ByteBuffer* request,
                                            grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* GetActivity(grpc::CallbackServerContext* context, const grpc::ByteBuffer* request,
                                        grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* GetWebhookSecret(grpc::CallbackServerContext* context, const grpc::ByteBuffer* request,
                                             grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* RotateWebhookSecret(grpc::CallbackServerContext* context, const grpc::ByteBuffer* request,
                                                grpc::ByteBuffer* response) override;

 private:
  Backend& backend_;
  const Capabilities capabilities_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_SCENE_SERVICE_H_
