// SPDX-License-Identifier: Apache-2.0
// Each call, however it ends, is counted once, and has its line in the logs.
#include "server/service/call_telemetry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/execution/clock.h"
#include "grpcpp/generic/generic_stub.h"
#include "nlohmann/json.hpp"
#include "tests/support/loopback/class_test.h"
#include "tests/support/loopback/loopback_server.h"

namespace flatlight {
namespace {

using grpc::StatusCode;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::TestContext;

struct Answer {
  grpc::Status status;
  std::string request_id;
};

// A call of any kind with one message, of whatever method.
Answer CallPath(const std::shared_ptr<grpc::Channel>& channel, const std::string& path, const std::string& token,
                const std::string& message = "", const std::string& request_id = "") {
  TestContext context;
  if (!token.empty()) context.AddMetadata("authorization", "Bearer " + token);
  if (!request_id.empty()) context.AddMetadata(CallTelemetry::kRequestId, request_id);
  grpc::CompletionQueue queue;
  const auto await = [&queue] {
    void* tag = nullptr;
    bool ok = false;
    return queue.Next(&tag, &ok) && ok;
  };
  grpc::GenericStub stub(channel);
  const auto call = stub.PrepareCall(&context, path, &queue);
  call->StartCall(nullptr);
  await();
  const grpc::Slice slice(message);
  call->WriteLast(grpc::ByteBuffer(&slice, 1), {}, nullptr);
  await();
  grpc::ByteBuffer read;
  do {
    call->Read(&read, nullptr);
  } while (await());
  Answer answer;
  call->Finish(&answer.status, nullptr);
  await();
  const auto& metadata = context.GetServerInitialMetadata();
  const auto id = metadata.find(CallTelemetry::kRequestId);
  if (id != metadata.end()) answer.request_id.assign(id->second.data(), id->second.size());
  queue.Shutdown();
  return answer;
}

// "RenderService/CreateJob" and so on: all that there are.
std::vector<std::string> AllMethods() {
  std::vector<std::string> methods;
  for (const auto* file : {v1::Job::descriptor()->file(), v1::SceneInfo::descriptor()->file(),
                           v1::GetActivityRequest::descriptor()->file(), v1::Room::descriptor()->file()}) {
    for (int s = 0; s < file->service_count(); ++s) {
      for (int m = 0; m < file->service(s)->method_count(); ++m) {
        methods.push_back(file->service(s)->name() + "/" + file->service(s)->method(m)->name());
      }
    }
  }
  return methods;
}

class CallTelemetryTest : public testing::ClassTest {
 protected:
  void StartLogged(ServerOptions options = {}) {
    options.log = folder_.path() + "/calls.jsonl";
    Start(std::move(options));
    channel_ = server_->NewChannel();
  }
  Answer Ask(const std::string& method, const std::string& token, const std::string& message = "") {
    return CallPath(channel_, "/flatlight.v1." + method, token, message);
  }
  double Counted(const std::string& series) {
    const std::string text = "\n" + server_->server().MetricsText();
    const std::size_t at = text.find("\n" + series + " ");
    return at == std::string::npos ? 0 : std::stod(text.substr(at + series.size() + 2));
  }
  double Calls(const std::string& method, const std::string& code) {
    return Counted("flatlight_calls_total{code=\"" + code + "\",method=\"" + method + "\"}");
  }
  // The lines about calls of a method.
  std::vector<nlohmann::json> Lines(const std::string& file, const std::string& method) {
    std::ifstream in(folder_.path() + "/" + file);
    std::vector<nlohmann::json> lines;
    for (std::string text; std::getline(in, text);) {
      auto line = nlohmann::json::parse(text);
      if (line["method"] == method) lines.push_back(std::move(line));
    }
    return lines;
  }

  std::shared_ptr<grpc::Channel> channel_;
};

TEST_F(CallTelemetryTest, WhoIsUnknownIsCountedAndLoggedWithEveryMethod) {
  ServerOptions options;
  options.token = "secret";
  StartLogged(options);
  const auto methods = AllMethods();
  ASSERT_GE(methods.size(), 32u);
  for (const std::string& method : methods) {
    SCOPED_TRACE(method);
    const Answer answer = Ask(method, "");
    EXPECT_EQ(answer.status.error_code(), StatusCode::UNAUTHENTICATED);
    EXPECT_EQ(Calls(method, "UNAUTHENTICATED"), 1);
    EXPECT_EQ(Counted("flatlight_call_seconds_count{method=\"" + method + "\"}"), 1);
    for (const char* file : {"calls.jsonl", "data/audit.jsonl"}) {
      const auto lines = Lines(file, method);
      ASSERT_EQ(lines.size(), 1u) << file;
      EXPECT_EQ(lines[0]["request"], answer.request_id);
      EXPECT_EQ(lines[0]["caller"], "");
      EXPECT_EQ(lines[0]["reason"], "BAD_TOKEN");
      EXPECT_THAT(std::string(lines[0]["peer"]), HasSubstr("127.0.0.1"));
    }
  }
  EXPECT_EQ(Counted("flatlight_refusals_total{reason=\"BAD_TOKEN\"}"), static_cast<double>(methods.size()));
}

TEST_F(CallTelemetryTest, WhatIsNoMessageIsCountedAndLoggedWithEveryMethod) {
  ServerOptions options;
  options.token = "secret";
  StartLogged(options);
  for (const std::string& method : AllMethods()) {
    SCOPED_TRACE(method);
    const Answer answer = Ask(method, "secret", "\xff\xff");
    EXPECT_EQ(answer.status.error_code(), StatusCode::INVALID_ARGUMENT);
    EXPECT_EQ(Calls(method, "INVALID_ARGUMENT"), 1);
    const auto lines = Lines("calls.jsonl", method);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0]["caller"], "owner");
    EXPECT_EQ(lines[0]["reason"], "NOT_A_MESSAGE");
    EXPECT_EQ(lines[0]["request"], answer.request_id);
  }
}

TEST_F(CallTelemetryTest, WhatIsSentIsMeasured) {
  StartLogged();
  TestContext context;
  v1::GetCapabilitiesResponse response;
  ASSERT_TRUE(server_->info().GetCapabilities(&context, {}, &response).ok());
  const auto lines = Lines("calls.jsonl", "ServerService/GetCapabilities");
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0]["sent_bytes"], response.ByteSizeLong());
  EXPECT_EQ(Counted("flatlight_sent_bytes_total{method=\"ServerService/GetCapabilities\"}"),
            static_cast<double>(response.ByteSizeLong()));
  EXPECT_EQ(lines[0]["caller"], "anonymous");
  EXPECT_GT(double{lines[0]["seconds"]}, 0);
  EXPECT_LT(double{lines[0]["seconds"]}, 60);
}

TEST_F(CallTelemetryTest, WhatThereIsNotIsCountedWithoutItsName) {
  StartLogged();
  for (const char* path : {"/flatlight.v1.RenderService/NoSuchCall", "/nobody.Service/Call"}) {
    const Answer answer = CallPath(channel_, path, "", "", "mine-8");
    EXPECT_EQ(answer.status.error_code(), StatusCode::UNIMPLEMENTED);
    EXPECT_EQ(answer.request_id, "mine-8");
  }
  EXPECT_EQ(Calls("other", "UNIMPLEMENTED"), 2);
  EXPECT_TRUE(CallPath(channel_, "/grpc.health.v1.Health/Check", "").status.ok());
  EXPECT_EQ(Calls("other", "OK"), 1);
  EXPECT_THAT(server_->server().MetricsText(), Not(HasSubstr("NoSuchCall")));
}

TEST_F(CallTelemetryTest, WhoIsRefusedIsNamed) {
  ServerOptions options;
  ASSERT_TRUE(options.quotas.Set("grader.requests=0.001").ok());
  StartLogged(options);
  AddClass();
  EXPECT_EQ(testing::ReasonOf(Ask("ReviewService/CreateRoom", tokens_["ada"]).status), "ROLE_TOO_LOW");
  const auto denied = Lines("data/audit.jsonl", "ReviewService/CreateRoom");
  ASSERT_EQ(denied.size(), 1u);
  EXPECT_EQ(denied[0]["caller"], "ada");

  EXPECT_TRUE(Ask("RenderService/ListJobs", tokens_["gus"]).status.ok()) << "the only one in a thousand seconds";
  for (const char* method : {"RenderService/GetJob", "RenderService/WatchJob", "RenderService/GetResult",
                             "ReviewService/WatchRoom", "SceneService/ListScenes"}) {
    SCOPED_TRACE(method);
    EXPECT_EQ(testing::ReasonOf(Ask(method, tokens_["gus"]).status), "TOO_MANY_REQUESTS");
    const auto lines = Lines("calls.jsonl", method);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0]["caller"], "gus");
    EXPECT_EQ(lines[0]["reason"], "TOO_MANY_REQUESTS");
  }
}

// Every call with a quota asks for the time: whoever does so is under way, and stays so until `go` is set.
class Gate final : public Clock {
 public:
  Time Now() const override {
    if (!closed.exchange(false)) return {};
    arrived.set_value();
    released.wait();
    return {};
  }
  mutable std::atomic<bool> closed = true;
  mutable std::promise<void> arrived;
  std::promise<void> go;
  std::shared_future<void> released = go.get_future().share();
};

TEST_F(CallTelemetryTest, WhoHasGoneIsCountedOnce) {
  Gate gate;
  ServerOptions options;
  options.request_clock = &gate;
  ASSERT_TRUE(options.quotas.Set("admin.requests=1000").ok());
  StartLogged(options);
  TestContext context;
  auto call = std::async(std::launch::async, [&] {
    v1::GetCapabilitiesResponse response;
    return server_->info().GetCapabilities(&context, {}, &response);
  });
  gate.arrived.get_future().wait();
  context.TryCancel();
  EXPECT_EQ(call.get().error_code(), StatusCode::CANCELLED);
  gate.go.set_value();
  const std::string method = "ServerService/GetCapabilities";
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (Lines("calls.jsonl", method).empty() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
  server_.reset();
  EXPECT_EQ(Lines("calls.jsonl", method).size(), 1u);
}

}  // namespace
}  // namespace flatlight
