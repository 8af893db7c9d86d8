// SPDX-License-Identifier: Apache-2.0
#include "tests/support/loopback/loopback_server.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "grpcpp/create_channel.h"

namespace flatlight::testing {

LoopbackServer::LoopbackServer(const ServerOptions& options) {
  auto server = Server::Start(options);
  if (!server.ok()) {
    std::fprintf(stderr, "%s\n", server.status().ToString().c_str());
    std::abort();
  }
  server_ = *std::move(server);
  channel_ = NewChannel();
  render_ = v1::RenderService::NewStub(channel_);
  scenes_ = v1::SceneService::NewStub(channel_);
  info_ = v1::ServerService::NewStub(channel_);
  review_ = v1::ReviewService::NewStub(channel_);
}

std::shared_ptr<grpc::Channel> LoopbackServer::NewChannel() const {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  arguments.SetMaxReceiveMessageSize(-1);
  return grpc::CreateCustomChannel(server_->address(), grpc::InsecureChannelCredentials(), arguments);
}

TestContext::TestContext() { set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(60)); }

v1::Scene FloorAndLampProto(const std::vector<std::uint32_t>& counts) {
  v1::Scene scene;
  scene.set_name("floor and lamp");
  v1::Plane& plane = *scene.mutable_plane();
  v1::Material& material = *plane.add_materials();
  material.set_name("white");
  material.mutable_lambertian()->add_reflectance(0.5);
  const auto add_segment = [&](const std::string& name, double x, double y) -> v1::Curve& {
    v1::Curve& curve = *plane.add_curves();
    curve.set_name(name);
    curve.set_material("white");
    curve.mutable_segment()->mutable_a()->set_x(x);
    curve.mutable_segment()->mutable_a()->set_y(y);
    curve.mutable_segment()->mutable_b()->set_x(-x);
    curve.mutable_segment()->mutable_b()->set_y(y);
    return curve;
  };
  add_segment("floor", -1, 0);
  add_segment("lamp", 1, 1).mutable_emission()->add_radiance(1);
  for (const std::uint32_t count : counts) {
    v1::Probe& probe = *scene.add_probes();
    probe.set_name("probe" + std::to_string(scene.probes_size() - 1));
    probe.set_curve("floor");
    probe.set_count(count);
  }
  return scene;
}

std::string ReasonOf(const grpc::Status& status) {
  const auto info = DetailOf<google::rpc::ErrorInfo>(status);
  return info ? info->reason() : "";
}

}  // namespace flatlight::testing
