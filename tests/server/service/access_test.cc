// SPDX-License-Identifier: Apache-2.0
// Who may do what, over a real connection and a real database.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
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
using testing::TestContext;

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

TEST_F(AccessTest, UploadsAreListedToStaffAndDeletedByInstructors) {
  Start();
  AddClass();
  std::string json;
  ASSERT_TRUE(google::protobuf::util::MessageToJsonString(testing::FloorAndLampProto({4}), &json).ok());
  v1::UploadSceneRequest upload;
  upload.set_sha256(Sha256Of(json));
  upload.set_total_bytes(json.size());
  upload.set_data(json);
  TestContext uploading;
  Identify("ada", uploading);
  v1::UploadSceneResponse uploaded;
  ASSERT_TRUE(server_->scenes().UploadScene(&uploading, upload, &uploaded).ok());
  const std::string name = "scenes/" + upload.sha256();

  const auto is_listed = [&](const std::string& user) {
    TestContext context;
    Identify(user, context);
    v1::ListScenesRequest request;
    request.set_page_size(1000);
    v1::ListScenesResponse response;
    EXPECT_TRUE(server_->scenes().ListScenes(&context, request, &response).ok());
    EXPECT_GT(response.scenes_size(), 10) << "the gallery is everybody's";
    return std::any_of(response.scenes().begin(), response.scenes().end(),
                       [&](const v1::SceneInfo& scene) { return scene.name() == name; });
  };
  EXPECT_FALSE(is_listed("ada"));
  EXPECT_FALSE(is_listed("bob"));
  EXPECT_TRUE(is_listed("gus"));
  const auto remove = [&](const std::string& user) {
    TestContext context;
    Identify(user, context);
    v1::DeleteSceneRequest request;
    request.set_name(name);
    v1::DeleteSceneResponse response;
    return server_->scenes().DeleteScene(&context, request, &response);
  };
  EXPECT_EQ(ReasonOf(remove("bob")), "ROLE_TOO_LOW");
  EXPECT_EQ(ReasonOf(remove("gus")), "ROLE_TOO_LOW");
  EXPECT_TRUE(remove("ina").ok());
}

}  // namespace
}  // namespace flatlight
