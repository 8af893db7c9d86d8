// SPDX-License-Identifier: Apache-2.0
// What one student has the server do is not told to another one by what the server remembers of it: two of a class
// upload the same scene and render it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <regex>
#include <string>
#include <vector>

#include "core/render/index_cache.h"
#include "server/convert/scene_convert.h"
#include "tests/support/loopback/class_test.h"
#include "tests/support/loopback/loopback_server.h"

namespace flatlight {
namespace {

using ::testing::HasSubstr;
using RenderStub = v1::RenderService::Stub;
using SceneStub = v1::SceneService::Stub;

class IsolationTest : public testing::ClassTest {
 protected:
  void SetUp() override {
    Restart();
    AddClass();
  }
  void Restart() {
    server_.reset();
    ServerOptions options;
    options.indexes = &indexes_;
    Start(options);
  }
  // Of the scene `name`, rendered to its end.
  v1::Job Render(const std::string& user, const std::string& name) {
    v1::CreateJobRequest request;
    request.mutable_scene()->set_name(name);
    request.mutable_settings()->set_method(v1::Settings::REFERENCE);
    request.mutable_settings()->set_target_error(1e-3);
    v1::Job job;
    const grpc::Status created = Call(user, request, job, &RenderStub::CreateJob);
    EXPECT_TRUE(created.ok()) << created.error_message();
    EXPECT_TRUE(Watch(user, job.name()).ok());
    v1::GetJobRequest get;
    get.set_name(job.name());
    EXPECT_TRUE(Call(user, get, job, &RenderStub::GetJob).ok());
    EXPECT_EQ(job.state(), v1::Job::SUCCEEDED) << job.error().message();
    return job;
  }

  IndexCache indexes_{1'000'000, 256u << 20};
};

TEST_F(IsolationTest, EqualWorkOnAnUploadIsDoneOnceByEach) {
  const std::string name = Upload("ada", "the same");
  ASSERT_EQ(Upload("bob", "the same"), name);
  EXPECT_FALSE(Render("ada", name).shared_work());
  EXPECT_TRUE(Render("ada", name).shared_work());
  EXPECT_FALSE(Render("bob", name).shared_work());
  EXPECT_TRUE(Render("bob", name).shared_work());
}

TEST_F(IsolationTest, SoItIsAfterARestart) {
  const std::string name = Upload("ada", "the same");
  Upload("bob", "the same");
  const v1::Job first = Render("ada", name);
  Restart();
  const v1::Job again = Render("ada", name);
  EXPECT_TRUE(again.shared_work());
  EXPECT_FALSE(Render("bob", name).shared_work());
  Restart();
  EXPECT_TRUE(Render("bob", name).shared_work());
  // What is deleted is not found.
  for (const std::string& job : List("ada")) ASSERT_TRUE(Delete("ada", job).ok());
  Restart();
  EXPECT_FALSE(Render("ada", name).shared_work());
}

TEST_F(IsolationTest, ThePublishedIsSharedByAllOverRestartsToo) {
  EXPECT_FALSE(Render("ada", "scenes/unit-light").shared_work());
  EXPECT_TRUE(Render("bob", "scenes/unit-light").shared_work());
  Restart();
  EXPECT_TRUE(Render("cyd", "scenes/unit-light").shared_work());
}

TEST_F(IsolationTest, IndexesAndSolvedWorldsAreEachOnesOwn) {
  const std::string name = Upload("ada", "the same");
  Upload("bob", "the same");
  Diagnostics diagnostics;
  const std::shared_ptr<const Scene> mine = SceneFromProto(testing::FloorAndLampProto({4}), diagnostics);
  ASSERT_NE(mine, nullptr);
  const auto solved_for = [&](const std::string& sharers) {
    auto world = indexes_.solved_worlds()->Take(*mine, 1, std::nullopt, sharers);
    const bool found = world != nullptr;
    if (found) indexes_.solved_worlds()->Keep(std::move(world), sharers);
    return found;
  };
  Render("ada", name);
  EXPECT_TRUE(solved_for("user ada"));
  EXPECT_FALSE(solved_for("user bob"));
  EXPECT_FALSE(solved_for("everybody"));
  EXPECT_FALSE(solved_for(""));
  Render("bob", name);
  EXPECT_TRUE(solved_for("user bob"));
  // A caster that is found has the scene of the job that made it, a new one that of who asks.
  const auto ada = indexes_.For(mine, "user ada"), bob = indexes_.For(mine, "user bob"),
             cyd = indexes_.For(mine, "user cyd");
  EXPECT_NE(&ada->scene(), mine.get());
  EXPECT_NE(&bob->scene(), mine.get());
  EXPECT_NE(ada, bob);
  EXPECT_EQ(&cyd->scene(), mine.get());
}

TEST_F(IsolationTest, NoAnswerTellsThatAnotherOneHasTheScene) {
  const auto file_of = [](const std::string& title) {
    v1::Scene scene = testing::FloorAndLampProto({4});
    scene.set_name(title);
    std::string json;
    EXPECT_TRUE(google::protobuf::util::MessageToJsonString(scene, &json).ok());
    return json;
  };
  Upload("ada", "of ada");
  Render("ada", "scenes/" + Sha256Of(file_of("of ada")));
  // All that bob is told on the way of a file to the server, and about it, without its hash.
  const auto answers = [&](const std::string& json) {
    const std::string sha256 = Sha256Of(json);
    std::string all;
    const auto note = [&](const grpc::Status& status, const google::protobuf::Message& response) {
      std::string text;
      EXPECT_TRUE(google::protobuf::util::MessageToJsonString(response, &text).ok());
      all += std::to_string(status.error_code()) + " " + status.error_message() + " " + text + "\n";
    };
    const auto upload = [&](std::size_t offset, std::size_t count) {
      v1::UploadSceneRequest request;
      request.set_sha256(sha256);
      request.set_total_bytes(json.size());
      request.set_offset(offset);
      request.set_data(json.substr(offset, count));
      v1::UploadSceneResponse response;
      note(CallScenes("bob", request, response, &SceneStub::UploadScene), response);
    };
    const auto get = [&] {
      v1::GetSceneRequest request;
      request.set_name("scenes/" + sha256);
      v1::GetSceneResponse response;
      note(CallScenes("bob", request, response, &SceneStub::GetScene), response.info());
      v1::ExplainJobRequest explain;
      explain.mutable_scene()->set_name("scenes/" + sha256);
      v1::ExplainJobResponse explained;
      note(Call("bob", explain, explained, &RenderStub::ExplainJob), explained);
      v1::DeleteSceneRequest remove;
      remove.set_name("scenes/" + sha256);
      v1::DeleteSceneResponse removed;
      note(CallScenes("bob", remove, removed, &SceneStub::DeleteScene), removed);
    };
    get();
    upload(0, 0);  // How much is there?
    upload(0, 10);
    upload(20, 10);  // Not where it goes on.
    upload(0, 0);
    get();
    upload(10, json.size());
    upload(0, 0);
    get();
    get();
    return std::regex_replace(all, std::regex(sha256), "HASH");
  };
  const std::string of_both = answers(file_of("of ada")), of_none = answers(file_of("of bob"));
  EXPECT_EQ(std::regex_replace(of_both, std::regex("of ada"), "of bob"), of_none);
  EXPECT_THAT(of_none, HasSubstr("\"receivedBytes\":\"10\""));
  EXPECT_THAT(of_none, HasSubstr("Path tracing")) << "The upload was whole, and explained.";
}

}  // namespace
}  // namespace flatlight
