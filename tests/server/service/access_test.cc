// SPDX-License-Identifier: Apache-2.0
// Who may do what, over a real connection and a real database.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "google/protobuf/util/json_util.h"
#include "server/service/policy.h"
#include "server/store/sha256.h"
#include "server/store/user_store.h"
#include "tests/support/loopback/class_test.h"
#include "tests/support/loopback/loopback_server.h"

namespace flatlight {
namespace {

using grpc::StatusCode;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::ReasonOf;
using ::testing::SizeIs;

TEST(PolicyTest, EveryRpcHasARowAndEveryRowAnRpc) {
  std::set<std::string> requests;
  for (const auto* file : {v1::Job::descriptor()->file(), v1::SceneInfo::descriptor()->file(),
                           v1::GetActivityRequest::descriptor()->file(), v1::Room::descriptor()->file()}) {
    for (int s = 0; s < file->service_count(); ++s) {
      for (int m = 0; m < file->service(s)->method_count(); ++m) {
        const auto* rpc = file->service(s)->method(m);
        EXPECT_TRUE(requests.insert(rpc->input_type()->name()).second) << rpc->full_name() << " shares its request";
      }
    }
  }
  EXPECT_GE(requests.size(), 29u);
  std::set<std::string> rows;
  for (const PolicyRow& row : Policy()) EXPECT_TRUE(rows.insert(std::string(row.request)).second) << row.request;
  EXPECT_EQ(rows, requests);
  EXPECT_EQ(CheckRole({"ada", Role::kAdmin}, "SomeNewRequest").code(), absl::StatusCode::kPermissionDenied);
}

using AccessTest = testing::ClassTest;

TEST_F(AccessTest, WithTheFirstUserTokensAreAskedFor) {
  Start();
  const v1::Job before = Create("");
  AddClass();
  EXPECT_EQ(ReasonOf(Get("", before.name())), "BAD_TOKEN");
  EXPECT_EQ(ReasonOf(Watch("", before.name())), "BAD_TOKEN");
  EXPECT_EQ(ReasonOf(Fetch("", before.name())), "BAD_TOKEN");
  EXPECT_EQ(ReasonOf(Get("flatlight_guess", before.name())), "TOKEN_INVALID");
  EXPECT_THAT(List("ada"), IsEmpty());
  EXPECT_THAT(List("ina"), ElementsAre(before.name()));
  ASSERT_TRUE(UserStore(*database_).Revoke("ada").ok());
  EXPECT_EQ(Get("ada", before.name()).error_code(), StatusCode::UNAUTHENTICATED);
  for (const auto& [user, token] : tokens_) {
    if (user != "ada") {
      ASSERT_TRUE(UserStore(*database_).Revoke(user).ok());
    }
  }
  EXPECT_EQ(ReasonOf(Get("", before.name())), "BAD_TOKEN") << "revoking the last user opens nothing";
}

TEST_F(AccessTest, TheServersOwnTokenStaysBesideUsers) {
  Start("secret");
  EXPECT_EQ(ReasonOf(Get("", "jobs/x")), "BAD_TOKEN");
  AddClass();
  const v1::Job job = Create("ada");
  EXPECT_TRUE(Get("secret", job.name()).ok());
  EXPECT_EQ(Get("secret2", job.name()).error_code(), StatusCode::UNAUTHENTICATED);
}

TEST_F(AccessTest, WhatIsNotOnesOwnIsNotThere) {
  Start();
  AddClass();
  const std::string job = Create("ada").name();
  ASSERT_TRUE(Watch("ada", job).ok());
  EXPECT_THAT(List("ada"), ElementsAre(job));
  EXPECT_THAT(List("bob"), IsEmpty());
  const std::string none = "jobs/00000000-0000-4000-8000-000000000000";
  const auto hidden = [&](const auto& call) {
    const grpc::Status forbidden = call(job);
    const grpc::Status unknown = call(none);
    EXPECT_EQ(forbidden.error_code(), StatusCode::NOT_FOUND) << forbidden.error_message();
    std::string same = unknown.error_message();
    if (const std::size_t at = same.find(none); at != std::string::npos) same.replace(at, none.size(), job);
    EXPECT_EQ(forbidden.error_message(), same);
    EXPECT_EQ(ReasonOf(forbidden), ReasonOf(unknown));
  };
  hidden([&](const std::string& name) { return Get("bob", name); });
  hidden([&](const std::string& name) { return Watch("bob", name); });
  hidden([&](const std::string& name) { return Watch("bob", name, true); });
  hidden([&](const std::string& name) { return Fetch("bob", name); });
  hidden([&](const std::string& name) { return Cancel("bob", name); });
  hidden([&](const std::string& name) { return Pause("bob", name); });
  hidden([&](const std::string& name) { return Resume("bob", name); });
  hidden([&](const std::string& name) { return Delete("bob", name); });

  // A grader sees it, and changes nothing.
  EXPECT_THAT(List("gus"), ElementsAre(job));
  EXPECT_TRUE(Fetch("gus", job).ok());
  EXPECT_TRUE(Watch("gus", job).ok());
  EXPECT_EQ(ReasonOf(Watch("gus", job, true)), "NOT_YOUR_JOB");
  EXPECT_EQ(ReasonOf(Cancel("gus", job)), "NOT_YOUR_JOB");
  EXPECT_EQ(ReasonOf(Delete("gus", job)), "NOT_YOUR_JOB");
  EXPECT_TRUE(Delete("ina", job).ok());
  EXPECT_EQ(Get("ada", job).error_code(), StatusCode::NOT_FOUND);
}

TEST_F(AccessTest, RecordsOfAnothersJobAreNotKnown) {
  Start();
  AddClass();
  const std::string job = Create("ada").name();
  ASSERT_TRUE(Watch("ada", job).ok());
  v1::CreateJobRequest request;
  *request.mutable_scene()->mutable_scene() = testing::FloorAndLampProto({4});
  request.mutable_settings()->set_method(v1::Settings::IRRADIANCE_CACHING);
  request.mutable_records()->set_job(job);
  v1::Job made;
  EXPECT_THAT(Call("bob", request, made, &v1::RenderService::Stub::CreateJob).error_message(),
              HasSubstr("is not known here"));
  EXPECT_THAT(Call("ada", request, made, &v1::RenderService::Stub::CreateJob).error_message(),
              HasSubstr("has made no records"));
}

class SceneAccessTest : public AccessTest {
 public:
  void SetUp() override {
    Start();
    AddClass();
    v1::Scene scene = testing::FloorAndLampProto({4});
    scene.set_name("a floor and a lamp");
    ASSERT_TRUE(google::protobuf::util::MessageToJsonString(scene, &json_).ok());
    name_ = "scenes/" + Sha256Of(json_);
  }
  // Returns how many bytes are there.
  std::uint64_t UploadPiece(const std::string& user, std::size_t offset, std::size_t size) {
    v1::UploadSceneRequest request;
    request.set_sha256(Sha256Of(json_));
    request.set_total_bytes(json_.size());
    request.set_offset(offset);
    request.set_data(json_.substr(offset, size));
    v1::UploadSceneResponse response;
    const auto status = CallScenes(user, request, response, &v1::SceneService::Stub::UploadScene);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response.received_bytes();
  }
  void Upload(const std::string& user) { ASSERT_EQ(UploadPiece(user, 0, json_.size()), json_.size()); }
  // Uploads that are listed, with their titles.
  std::map<std::string, std::string> Uploads(const std::string& user) {
    v1::ListScenesRequest request;
    request.set_page_size(1000);
    v1::ListScenesResponse response;
    EXPECT_TRUE(CallScenes(user, request, response, &v1::SceneService::Stub::ListScenes).ok());
    EXPECT_GT(response.scenes_size(), 10) << "the gallery is everybody's";
    std::map<std::string, std::string> uploads;
    for (const v1::SceneInfo& scene : response.scenes()) {
      if (!scene.gallery()) uploads[scene.name()] = scene.title();
    }
    return uploads;
  }
  grpc::Status Read(const std::string& user, const std::string& name) {
    v1::GetSceneRequest request;
    request.set_name(name);
    v1::GetSceneResponse response;
    return CallScenes(user, request, response, &v1::SceneService::Stub::GetScene);
  }
  grpc::Status Validate(const std::string& user, const std::string& name) {
    v1::ValidateSceneRequest request;
    request.mutable_scene()->set_name(name);
    v1::ValidateSceneResponse response;
    return CallScenes(user, request, response, &v1::SceneService::Stub::ValidateScene);
  }
  grpc::Status Remove(const std::string& user, const std::string& name) {
    v1::DeleteSceneRequest request;
    request.set_name(name);
    v1::DeleteSceneResponse response;
    return CallScenes(user, request, response, &v1::SceneService::Stub::DeleteScene);
  }
  grpc::Status Render(const std::string& user, const std::string& name) {
    v1::CreateJobRequest request;
    request.mutable_scene()->set_name(name);
    request.mutable_settings()->set_samples(16);
    v1::Job job;
    return Call(user, request, job, &v1::RenderService::Stub::CreateJob);
  }
  grpc::Status Explain(const std::string& user, const std::string& name) {
    v1::ExplainJobRequest request;
    request.mutable_scene()->set_name(name);
    v1::ExplainJobResponse response;
    return Call(user, request, response, &v1::RenderService::Stub::ExplainJob);
  }

  std::string json_;
  std::string name_;
};

TEST_F(SceneAccessTest, AnUploadIsItsOwnersAndTheStaffs) {
  Upload("ada");
  const std::string none = "scenes/" + Sha256Of("nothing");
  for (const auto call : {&SceneAccessTest::Read, &SceneAccessTest::Validate, &SceneAccessTest::Render,
                          &SceneAccessTest::Explain, &SceneAccessTest::Remove}) {
    const grpc::Status forbidden = (this->*call)("bob", name_);
    const grpc::Status unknown = (this->*call)("bob", none);
    EXPECT_EQ(forbidden.error_code(), StatusCode::NOT_FOUND) << "who knows the hash has nothing yet";
    EXPECT_EQ(ReasonOf(forbidden), ReasonOf(unknown));
    EXPECT_EQ(forbidden.error_message(), name_ + " does not exist");
    EXPECT_EQ(unknown.error_message(), none + " does not exist");
  }
  EXPECT_THAT(Uploads("bob"), IsEmpty());
  for (const char* user : {"ada", "gus", "ina"}) {
    EXPECT_THAT(Uploads(user), SizeIs(1)) << user;
    EXPECT_TRUE(Read(user, name_).ok()) << user;
    EXPECT_TRUE(Validate(user, name_).ok()) << user;
    EXPECT_TRUE(Explain(user, name_).ok()) << user;
    EXPECT_TRUE(Render(user, name_).ok()) << user;
  }
  EXPECT_EQ(ReasonOf(Remove("gus", name_)), "NOT_YOUR_SCENE");
  EXPECT_TRUE(Remove("ada", name_).ok());
  EXPECT_EQ(Read("ina", name_).error_code(), StatusCode::NOT_FOUND);
}

TEST_F(SceneAccessTest, AnUploadTellsNothingOfWhatOthersHave) {
  Upload("ada");
  ASSERT_TRUE(Validate("ada", name_).ok());
  EXPECT_EQ(Uploads("ada").at(name_), "a floor and a lamp");
  EXPECT_EQ(UploadPiece("bob", 0, 0), 0u) << "a call without data asks";
  EXPECT_EQ(UploadPiece("bob", 0, 10), 10u);
  EXPECT_EQ(UploadPiece("gus", 0, 0), 0u) << "nor how far another one is";
  EXPECT_THAT(Uploads("bob"), IsEmpty());
  EXPECT_EQ(UploadPiece("bob", 10, json_.size()), json_.size());
  EXPECT_EQ(Uploads("bob").at(name_), "") << "a title would tell that somebody has read it";
  EXPECT_EQ(UploadPiece("bob", 0, 0), json_.size()) << "but one's own is known";
  EXPECT_EQ(Uploads("gus").at(name_), "a floor and a lamp");
}

TEST_F(SceneAccessTest, OwnersAreRememberedAndTheLastOneTakesTheScene) {
  Upload("ada");
  Upload("bob");
  server_.reset();
  Start();
  EXPECT_TRUE(Read("bob", name_).ok());
  ASSERT_TRUE(Remove("ada", name_).ok());
  EXPECT_EQ(Read("ada", name_).error_code(), StatusCode::NOT_FOUND);
  EXPECT_EQ(Remove("ada", name_).error_code(), StatusCode::NOT_FOUND);
  server_.reset();
  Start();
  EXPECT_THAT(Uploads("ada"), IsEmpty());
  EXPECT_TRUE(Read("bob", name_).ok());
  ASSERT_TRUE(Remove("bob", name_).ok());
  EXPECT_THAT(Uploads("gus"), IsEmpty());
  EXPECT_EQ(Read("gus", name_).error_code(), StatusCode::NOT_FOUND);
}

TEST_F(SceneAccessTest, AnInstructorTakesASceneFromAll) {
  Upload("ada");
  Upload("bob");
  ASSERT_TRUE(Remove("ina", name_).ok());
  server_.reset();
  Start();
  for (const char* user : {"ada", "bob", "gus"}) EXPECT_THAT(Uploads(user), IsEmpty()) << user;
  EXPECT_EQ(UploadPiece("ada", 0, 0), 0u);
}

}  // namespace
}  // namespace flatlight
