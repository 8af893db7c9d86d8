// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_TESTS_SUPPORT_LOOPBACK_LOOPBACK_SERVER_H_
#define FLATLIGHT_TESTS_SUPPORT_LOOPBACK_LOOPBACK_SERVER_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flatlight/v1/render_service.grpc.pb.h"
#include "flatlight/v1/review_service.grpc.pb.h"
#include "flatlight/v1/scene_service.grpc.pb.h"
#include "flatlight/v1/server_service.grpc.pb.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/error_info.pb.h"
#include "google/rpc/status.pb.h"
#include "grpcpp/channel.h"
#include "grpcpp/client_context.h"
#include "server/service/server.h"

namespace flatlight::testing {

// A server in this process on a free loopback port, and stubs that reach it over TCP.
class LoopbackServer {
 public:
  explicit LoopbackServer(const ServerOptions& options = {});

  Server& server() { return *server_; }
  // A connection of its own.
  std::shared_ptr<grpc::Channel> NewChannel() const;

  v1::RenderService::Stub& render() { return *render_; }
  v1::SceneService::Stub& scenes() { return *scenes_; }
  v1::ServerService::Stub& info() { return *info_; }
  v1::ReviewService::Stub& review() { return *review_; }

 private:
  std::unique_ptr<Server> server_;
  std::shared_ptr<grpc::Channel> channel_;
  std::unique_ptr<v1::RenderService::Stub> render_;
  std::unique_ptr<v1::SceneService::Stub> scenes_;
  std::unique_ptr<v1::ServerService::Stub> info_;
  std::unique_ptr<v1::ReviewService::Stub> review_;
};

// A context with a deadline that only a hanging server reaches.
class TestContext : public grpc::ClientContext {
 public:
  TestContext();
};

// A floor under a lamp; one probe on the floor for each number, with that many points.
v1::Scene FloorAndLampProto(const std::vector<std::uint32_t>& counts);

// A detail of an error, if there is one of that type.
template <class Detail>
std::optional<Detail> DetailOf(const grpc::Status& status) {
  google::rpc::Status rpc;
  rpc.ParseFromString(status.error_details());
  for (const auto& any : rpc.details()) {
    Detail detail;
    if (any.UnpackTo(&detail)) return detail;
  }
  return std::nullopt;
}

// The reason in an error's ErrorInfo; empty if there is none.
std::string ReasonOf(const grpc::Status& status);

}  // namespace flatlight::testing

#endif  // FLATLIGHT_TESTS_SUPPORT_LOOPBACK_LOOPBACK_SERVER_H_
