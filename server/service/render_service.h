// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_RENDER_SERVICE_H_
#define FLATLIGHT_SERVER_SERVICE_RENDER_SERVICE_H_

#include <memory>

#include "flatlight/v1/render_service.grpc.pb.h"
#include "server/service/backend.h"
#include "server/service/job_watch.h"
#include "server/service/result_cache.h"
#include "server/service/watch_hub.h"

namespace flatlight {

template <class Base>
using RawRenderUnary = v1::RenderService::WithRawCallbackMethod_CreateJob<
    v1::RenderService::WithRawCallbackMethod_GetJob<v1::RenderService::WithRawCallbackMethod_ListJobs<
        v1::RenderService::WithRawCallbackMethod_CancelJob<v1::RenderService::WithRawCallbackMethod_PauseJob<
            v1::RenderService::WithRawCallbackMethod_ResumeJob<v1::RenderService::WithRawCallbackMethod_DeleteJob<
                v1::RenderService::WithRawCallbackMethod_ShareJob<v1::RenderService::WithRawCallbackMethod_UnshareJob<
                    v1::RenderService::WithRawCallbackMethod_ExplainJob<Base>>>>>>>>>>;
using RawRenderService = RawRenderUnary<v1::RenderService::WithRawCallbackMethod_WatchJob<
    v1::RenderService::WithRawCallbackMethod_GetResult<v1::RenderService::Service>>>;

// gRPC's side of RenderService; the calls themselves are in render_calls.h, job_watch.h and result_stream.h.
class RenderService final : public RawRenderService {
 public:
  RenderService(Backend& backend, WatchHub& hub) : backend_(backend), hub_(hub) {}

  using Context = grpc::CallbackServerContext;
  using Bytes = grpc::ByteBuffer;
  grpc::ServerUnaryReactor* CreateJob(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* GetJob(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* ListJobs(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* CancelJob(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* PauseJob(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* ResumeJob(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* DeleteJob(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* ShareJob(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* UnshareJob(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* ExplainJob(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerWriteReactor<Bytes>* WatchJob(Context* context, const Bytes* request) override;
  grpc::ServerWriteReactor<Bytes>* GetResult(Context* context, const Bytes* request) override;

 private:
  absl::StatusOr<std::shared_ptr<JobWatch>> StartWatch(const Context& context, const Bytes& bytes);

  Backend& backend_;
  WatchHub& hub_;
  ResultCache results_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_RENDER_SERVICE_H_
