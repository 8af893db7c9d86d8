// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/loopback/loopback_server.h"
#include "tests/support/rendering/fake_rendering.h"
#include "tests/support/status/temporary_folder.h"

namespace flatlight {
namespace {

using testing::LoopbackServer;
using testing::TestContext;

TEST(ConnectionLimits, LongMetadataAreRefused) {
  LoopbackServer server;
  for (const auto& [bytes, passes] : {std::pair(1000, true), std::pair(100'000, false)}) {
    TestContext context;
    context.AddMetadata("x-long", std::string(static_cast<std::size_t>(bytes), 'a'));
    v1::GetCapabilitiesResponse response;
    const grpc::Status status = server.info().GetCapabilities(&context, v1::GetCapabilitiesRequest(), &response);
    EXPECT_EQ(status.ok(), passes) << bytes << " " << status.error_message();
    if (!passes) {
      EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
    }
  }
}

grpc::Status AskCapabilities(const std::shared_ptr<grpc::Channel>& channel, std::chrono::milliseconds patience) {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + patience);
  v1::GetCapabilitiesResponse response;
  return v1::ServerService::NewStub(channel)->GetCapabilities(&context, v1::GetCapabilitiesRequest(), &response);
}

TEST(ConnectionLimits, AStreamTooManyWaitsForAnotherToEnd) {
  constexpr int kStreams = 1000;
  testing::FakeRenderings renderings(2);
  renderings.Hold();
  ServerOptions options;
  options.start_rendering = [&](std::shared_ptr<const Scene> scene, const Plan& plan) {
    return renderings.Start(scene, plan);
  };
  LoopbackServer server(options);
  v1::CreateJobRequest create;
  *create.mutable_scene()->mutable_scene() = testing::FloorAndLampProto({10});
  create.mutable_settings()->set_method(v1::Settings::PATH_TRACING);
  TestContext creating;
  v1::Job job;
  ASSERT_TRUE(server.render().CreateJob(&creating, create, &job).ok());

  const auto channel = server.NewChannel();
  const auto render = v1::RenderService::NewStub(channel);
  v1::WatchJobRequest watch;
  watch.set_name(job.name());
  std::vector<std::unique_ptr<TestContext>> contexts;
  std::vector<std::unique_ptr<grpc::ClientReader<v1::WatchJobResponse>>> readers;
  v1::WatchJobResponse message;
  for (int i = 0; i < kStreams; ++i) {
    contexts.push_back(std::make_unique<TestContext>());
    readers.push_back(render->WatchJob(contexts.back().get(), watch));
    ASSERT_TRUE(readers.back()->Read(&message)) << i;
  }
  EXPECT_EQ(AskCapabilities(channel, std::chrono::milliseconds(300)).error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
  EXPECT_TRUE(AskCapabilities(server.NewChannel(), std::chrono::seconds(60)).ok()) << "on another connection";
  contexts[0]->TryCancel();
  EXPECT_EQ(readers[0]->Finish().error_code(), grpc::StatusCode::CANCELLED);
  EXPECT_TRUE(AskCapabilities(channel, std::chrono::seconds(60)).ok()) << "in its place";
  for (const auto& context : contexts) context->TryCancel();
  for (std::size_t i = 1; i < readers.size(); ++i) readers[i]->Finish();
  renderings.Release();
}

// Large requests at the same time, each on its own connection; how many of them were read and looked at.
int ReadOfLargeRequests(std::size_t memory_bytes) {
  ServerOptions options;
  options.connection_memory_bytes = memory_bytes;
  LoopbackServer server(options);
  const std::string callers = "0123456789abcdef";
  std::vector<grpc::Status> statuses(callers.size());
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < callers.size(); ++i) {
    threads.emplace_back([&, i] {
      v1::UploadSceneRequest upload;
      upload.set_data(std::string(3u << 20, 'x'));
      upload.set_total_bytes(upload.data().size());
      upload.set_sha256(std::string(64, callers[i]));
      TestContext context;
      v1::UploadSceneResponse response;
      statuses[i] = v1::SceneService::NewStub(server.NewChannel())->UploadScene(&context, upload, &response);
    });
  }
  for (std::thread& thread : threads) thread.join();
  int read = 0;
  for (const grpc::Status& status : statuses) {
    if (status.error_code() == grpc::StatusCode::INVALID_ARGUMENT) {  // The hash is of other bytes.
      ++read;
    } else {
      EXPECT_THAT(status.error_code(),
                  ::testing::AnyOf(grpc::StatusCode::RESOURCE_EXHAUSTED, grpc::StatusCode::UNAVAILABLE))
          << status.error_message();
    }
  }
  EXPECT_TRUE(AskCapabilities(server.NewChannel(), std::chrono::seconds(60)).ok()) << "when they are over";
  return read;
}

TEST(ConnectionLimits, WhereMemoryIsTakenCallsAreRefused) {
  EXPECT_EQ(ReadOfLargeRequests(ServerOptions().connection_memory_bytes), 16);
  EXPECT_LT(ReadOfLargeRequests(1u << 20), 16);
}

// As HPACK writes a header that is in no table.
std::string Header(const std::string& name, const std::string& value) {
  return std::string(1, '\0') + static_cast<char>(name.size()) + name + static_cast<char>(value.size()) + value;
}

// A peer that has greeted and begun a call, as HTTP/2 wants it, and then vanishes.
TEST(ConnectionLimits, WhoNoLongerAnswersHasGone) {
  const testing::TemporaryFolder folder;
  ServerOptions options;
  options.address = "unix:" + folder.path() + "/socket";
  options.keepalive = std::chrono::milliseconds(50);
  LoopbackServer server(options);
  const int peer = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = folder.path() + "/socket";
  std::memcpy(address.sun_path, path.c_str(), path.size());
  ASSERT_EQ(connect(peer, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  const std::string headers = Header(":method", "POST") + Header(":scheme", "http") +
                              Header(":authority", "localhost") +
                              Header(":path", "/flatlight.v1.RenderService/WatchJob") +
                              Header("content-type", "application/grpc") + Header("te", "trailers");
  const std::string greeting = std::string("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n\0\0\0\x04\0\0\0\0\0", 33) +
                               std::string({'\0', '\0', static_cast<char>(headers.size()), 1, 4, 0, 0, 0, 1}) + headers;
  ASSERT_EQ(write(peer, greeting.data(), greeting.size()), static_cast<ssize_t>(greeting.size()));
  bool closed = false;
  std::array<char, 4096> received;
  for (pollfd ready{peer, POLLIN, 0}; !closed && poll(&ready, 1, 30'000) == 1;) {
    closed = read(peer, received.data(), received.size()) <= 0;
  }
  EXPECT_TRUE(closed);
  close(peer);
}

}  // namespace
}  // namespace flatlight
