// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_TESTS_SUPPORT_LOOPBACK_CLASS_TEST_H_
#define FLATLIGHT_TESTS_SUPPORT_LOOPBACK_CLASS_TEST_H_

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "google/protobuf/util/json_util.h"
#include "server/store/sha256.h"
#include "server/store/storage.h"
#include "server/store/user_store.h"
#include "tests/support/loopback/loopback_server.h"
#include "tests/support/status/temporary_folder.h"

namespace flatlight::testing {

// A server with a folder, and a class that uses it: students ada, bob (of lab-1) and cyd, a grader gus, an instructor
// ina.
class ClassTest : public ::testing::Test {
 protected:
  void Start(const std::string& token = "") {
    ServerOptions options;
    options.token = token;
    Start(options);
  }
  void Start(ServerOptions options) {
    options.data = folder_.path() + "/data";
    server_ = std::make_unique<LoopbackServer>(options);
    database_ = *Database::Open(Storage::DatabasePath(options.data));
  }
  void AddClass() {
    const std::vector<User> users = {{"ada", Role::kStudent, {}},
                                     {"bob", Role::kStudent, {"lab-1"}},
                                     {"cyd", Role::kStudent, {}},
                                     {"gus", Role::kGrader, {}},
                                     {"ina", Role::kInstructor, {}}};
    const auto tokens = UserStore(*database_).Add(users);
    ASSERT_TRUE(tokens.ok()) << tokens.status();
    for (std::size_t i = 0; i < users.size(); ++i) tokens_[users[i].name] = (*tokens)[i];
  }
  // `user`: of the class, or a token itself, or empty: no token.
  template <class Request, class Response>
  grpc::Status Call(const std::string& user, const Request& request, Response& response,
                    grpc::Status (v1::RenderService::Stub::*rpc)(grpc::ClientContext*, const Request&, Response*)) {
    TestContext context;
    Identify(user, context);
    return (server_->render().*rpc)(&context, request, &response);
  }
  template <class Request, class Response>
  grpc::Status CallScenes(const std::string& user, const Request& request, Response& response,
                          grpc::Status (v1::SceneService::Stub::*rpc)(grpc::ClientContext*, const Request&,
                                                                      Response*)) {
    TestContext context;
    Identify(user, context);
    return (server_->scenes().*rpc)(&context, request, &response);
  }
  void Identify(const std::string& user, grpc::ClientContext& context) {
    const auto token = tokens_.find(user);
    const std::string sent = token == tokens_.end() ? user : token->second;
    if (!sent.empty()) context.AddMetadata("authorization", "Bearer " + sent);
  }
  v1::Job Create(const std::string& user, std::uint32_t samples = 16) {
    v1::CreateJobRequest request;
    *request.mutable_scene()->mutable_scene() = FloorAndLampProto({4});
    request.mutable_settings()->set_method(v1::Settings::PATH_TRACING);
    request.mutable_settings()->set_samples(samples);
    v1::Job job;
    const grpc::Status status = Call(user, request, job, &v1::RenderService::Stub::CreateJob);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return job;
  }
  // A scene that differs from others by its title. Returns its name.
  std::string Upload(const std::string& user, const std::string& title) {
    v1::Scene scene = FloorAndLampProto({4});
    scene.set_name(title);
    std::string json;
    EXPECT_TRUE(google::protobuf::util::MessageToJsonString(scene, &json).ok());
    v1::UploadSceneRequest request;
    request.set_sha256(Sha256Of(json));
    request.set_total_bytes(json.size());
    request.set_data(json);
    v1::UploadSceneResponse response;
    EXPECT_TRUE(CallScenes(user, request, response, &v1::SceneService::Stub::UploadScene).ok());
    return response.name();
  }
  // A call about the job `name`.
  template <class Request, class Response>
  grpc::Status CallOn(const std::string& user, const std::string& name,
                      grpc::Status (v1::RenderService::Stub::*rpc)(grpc::ClientContext*, const Request&, Response*)) {
    Request request;
    request.set_name(name);
    Response response;
    return Call(user, request, response, rpc);
  }
  grpc::Status Get(const std::string& user, const std::string& name) {
    return CallOn(user, name, &v1::RenderService::Stub::GetJob);
  }
  std::vector<std::string> List(const std::string& user, bool shared = false) {
    v1::ListJobsRequest request;
    request.set_shared(shared);
    v1::ListJobsResponse response;
    EXPECT_TRUE(Call(user, request, response, &v1::RenderService::Stub::ListJobs).ok());
    std::vector<std::string> names;
    for (const v1::Job& job : response.jobs()) names.push_back(job.name());
    return names;
  }
  grpc::Status Delete(const std::string& user, const std::string& name) {
    return CallOn(user, name, &v1::RenderService::Stub::DeleteJob);
  }
  grpc::Status Cancel(const std::string& user, const std::string& name) {
    return CallOn(user, name, &v1::RenderService::Stub::CancelJob);
  }
  grpc::Status Pause(const std::string& user, const std::string& name) {
    return CallOn(user, name, &v1::RenderService::Stub::PauseJob);
  }
  grpc::Status Resume(const std::string& user, const std::string& name) {
    return CallOn(user, name, &v1::RenderService::Stub::ResumeJob);
  }
  // To its end.
  grpc::Status Watch(const std::string& user, const std::string& name, bool cancel_on_disconnect = false) {
    TestContext context;
    Identify(user, context);
    v1::WatchJobRequest request;
    request.set_name(name);
    request.set_cancel_on_disconnect(cancel_on_disconnect);
    const auto stream = server_->render().WatchJob(&context, request);
    v1::WatchJobResponse update;
    while (stream->Read(&update)) continue;
    return stream->Finish();
  }
  grpc::Status Fetch(const std::string& user, const std::string& name) {
    TestContext context;
    Identify(user, context);
    v1::GetResultRequest request;
    request.set_name(name);
    const auto stream = server_->render().GetResult(&context, request);
    v1::GetResultResponse chunk;
    while (stream->Read(&chunk)) continue;
    return stream->Finish();
  }

  TemporaryFolder folder_;
  std::unique_ptr<LoopbackServer> server_;
  std::unique_ptr<Database> database_;
  std::map<std::string, std::string> tokens_;
};

}  // namespace flatlight::testing

#endif  // FLATLIGHT_TESTS_SUPPORT_LOOPBACK_CLASS_TEST_H_
