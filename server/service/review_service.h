// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_REVIEW_SERVICE_H_
#define FLATLIGHT_SERVER_SERVICE_REVIEW_SERVICE_H_

#include <memory>

#include "flatlight/v1/review_service.grpc.pb.h"
#include "server/service/backend.h"
#include "server/service/review_calls.h"
#include "server/service/room_watch.h"
#include "server/service/watch_hub.h"

namespace flatlight {

template <class Base>
using RawReviewUnary =
    v1::ReviewService::WithRawCallbackMethod_CreateRoom<v1::ReviewService::WithRawCallbackMethod_GetRoom<
        v1::ReviewService::WithRawCallbackMethod_ListRooms<v1::ReviewService::WithRawCallbackMethod_ShareRoom<
            v1::ReviewService::WithRawCallbackMethod_UnshareRoom<v1::ReviewService::WithRawCallbackMethod_LookAt<
                v1::ReviewService::WithRawCallbackMethod_AddNote<v1::ReviewService::WithRawCallbackMethod_CloseRoom<
                    v1::ReviewService::WithRawCallbackMethod_DeleteRoom<Base>>>>>>>>>;
using RawReviewService = RawReviewUnary<v1::ReviewService::WithRawCallbackMethod_WatchRoom<v1::ReviewService::Service>>;

// gRPC's side of ReviewService; the calls themselves are in review_calls.h and room_watch.h.
class ReviewService final : public RawReviewService {
 public:
  ReviewService(Backend& backend, WatchHub& hub) : backend_(backend), hub_(hub), calls_(backend, hub) {}

  using Context = grpc::CallbackServerContext;
  using Bytes = grpc::ByteBuffer;
  grpc::ServerUnaryReactor* CreateRoom(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* GetRoom(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* ListRooms(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* ShareRoom(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* UnshareRoom(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* LookAt(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* AddNote(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* CloseRoom(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerUnaryReactor* DeleteRoom(Context* context, const Bytes* request, Bytes* response) override;
  grpc::ServerWriteReactor<Bytes>* WatchRoom(Context* context, const Bytes* request) override;

 private:
  template <class Request, class Result>
  grpc::ServerUnaryReactor* Call(Context* context, const Bytes* request, Bytes* response,
                                 Result (ReviewCalls::*call)(const Caller&, const Request&));
  absl::StatusOr<std::shared_ptr<RoomWatch>> StartWatch(const Context& context, const Bytes& bytes);

  Backend& backend_;
  WatchHub& hub_;
  ReviewCalls calls_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_REVIEW_SERVICE_H_
