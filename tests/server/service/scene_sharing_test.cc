// SPDX-License-Identifier: Apache-2.0
// Uploaded scenes that are shared, over real connections of a class.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "server/store/grants.h"
#include "tests/support/loopback/class_test.h"
#include "tests/support/loopback/loopback_server.h"

namespace flatlight {
namespace {

using grpc::StatusCode;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::ReasonOf;
using Stub = v1::SceneService::Stub;

class SceneSharingTest : public testing::ClassTest {
 protected:
  void SetUp() override {
    Start();
    AddClass();
    name_ = Upload("ada", "ada's");
  }
  // Its title is read.
  std::string Upload(const std::string& user, const std::string& title) {
    const std::string name = ClassTest::Upload(user, title);
    v1::ValidateSceneRequest validate;
    validate.mutable_scene()->set_name(name);
    v1::ValidateSceneResponse validated;
    EXPECT_TRUE(CallScenes(user, validate, validated, &Stub::ValidateScene).ok());
    return name;
  }
  grpc::Status Share(const std::string& user, const std::string& name, const std::string& grantee,
                     v1::Share::Access access = v1::Share::READ) {
    v1::ShareSceneRequest request;
    request.set_name(name);
    request.mutable_share()->set_grantee(grantee);
    request.mutable_share()->set_access(access);
    return CallScenes(user, request, info_, &Stub::ShareScene);
  }
  grpc::Status Unshare(const std::string& user, const std::string& name, const std::string& grantee) {
    v1::UnshareSceneRequest request;
    request.set_name(name);
    request.set_grantee(grantee);
    return CallScenes(user, request, info_, &Stub::UnshareScene);
  }
  // Into info_.
  grpc::Status Read(const std::string& user, const std::string& name) {
    v1::GetSceneRequest request;
    request.set_name(name);
    v1::GetSceneResponse response;
    grpc::Status status = CallScenes(user, request, response, &Stub::GetScene);
    info_ = response.info();
    return status;
  }
  grpc::Status Remove(const std::string& user, const std::string& name) {
    v1::DeleteSceneRequest request;
    request.set_name(name);
    v1::DeleteSceneResponse response;
    return CallScenes(user, request, response, &Stub::DeleteScene);
  }
  grpc::Status Render(const std::string& user, const std::string& name) {
    v1::CreateJobRequest request;
    request.mutable_scene()->set_name(name);
    request.mutable_settings()->set_samples(16);
    v1::Job job;
    return Call(user, request, job, &v1::RenderService::Stub::CreateJob);
  }
  enum class Whose { kShared, kOwn };
  // In pages of one.
  std::vector<std::string> Scenes(const std::string& user, Whose whose) {
    v1::ListScenesRequest request;
    request.set_page_size(1);
    request.set_shared(whose == Whose::kShared);
    request.set_own(whose == Whose::kOwn);
    std::vector<std::string> names;
    do {
      v1::ListScenesResponse page;
      const grpc::Status status = CallScenes(user, request, page, &Stub::ListScenes);
      EXPECT_TRUE(status.ok()) << status.error_message();
      EXPECT_TRUE(page.scenes_size() == 1 || (page.scenes().empty() && names.empty()));
      for (const v1::SceneInfo& scene : page.scenes()) {
        names.push_back(scene.name());
        infos_[scene.name()] = scene;
      }
      request.set_page_token(page.next_page_token());
    } while (!request.page_token().empty());
    return names;
  }
  // As one that is not there.
  void ExpectHidden(const grpc::Status& status, const std::string& name) {
    EXPECT_EQ(status.error_code(), StatusCode::NOT_FOUND);
    EXPECT_EQ(status.error_message(), name + " does not exist");
  }

  std::string name_;
  v1::SceneInfo info_;
  std::map<std::string, v1::SceneInfo> infos_;
};

TEST_F(SceneSharingTest, ReadersReadAndRenderAndNoMore) {
  ExpectHidden(Read("bob", name_), name_);
  ASSERT_TRUE(Share("ada", name_, "user:bob").ok());
  EXPECT_THAT(info_.owners(), ElementsAre("ada"));
  ASSERT_EQ(info_.shares_size(), 1);
  EXPECT_EQ(info_.shares(0).grantee(), "user:bob");
  EXPECT_TRUE(Render("bob", name_).ok());
  ASSERT_TRUE(Read("bob", name_).ok());
  EXPECT_THAT(info_.owners(), ElementsAre("ada"));
  EXPECT_THAT(info_.shares(), IsEmpty()) << "with whom else is its owner's to know";
  for (const grpc::Status& refused :
       {Share("bob", name_, "user:cyd"), Unshare("bob", name_, "user:bob"), Remove("bob", name_)}) {
    EXPECT_EQ(refused.error_code(), StatusCode::PERMISSION_DENIED);
    EXPECT_EQ(ReasonOf(refused), "NOT_YOUR_SCENE");
  }
  ExpectHidden(Read("cyd", name_), name_);
  ExpectHidden(Render("cyd", name_), name_);
  ExpectHidden(Share("cyd", name_, "user:cyd"), name_);
  ExpectHidden(Remove("cyd", name_), name_);
  EXPECT_EQ(ReasonOf(Share("ina", name_, "course")), "NOT_YOUR_SCENE");
  ASSERT_TRUE(Unshare("ada", name_, "user:bob").ok());
  ExpectHidden(Read("bob", name_), name_);
  ExpectHidden(Render("bob", name_), name_);
  EXPECT_EQ(ReasonOf(Unshare("ada", name_, "user:bob")), "SHARE_NOT_FOUND");
}

TEST_F(SceneSharingTest, ListsSayWhatIsSharedAndByWhom) {
  const std::string second = Upload("ada", "second");
  const std::string third = Upload("cyd", "third");
  Upload("cyd", "not shared");
  const std::string own = Upload("bob", "bob's");
  ASSERT_TRUE(Share("ada", name_, "group:lab-1").ok());
  ASSERT_TRUE(Share("ada", second, "group:lab-2").ok());
  ASSERT_TRUE(Share("cyd", third, "course").ok());
  ASSERT_TRUE(Share("bob", own, "course").ok());
  EXPECT_THAT(Scenes("bob", Whose::kShared), ElementsAre(third, name_));
  EXPECT_EQ(infos_[name_].title(), "ada's");
  EXPECT_THAT(infos_[name_].owners(), ElementsAre("ada"));
  EXPECT_THAT(Scenes("bob", Whose::kOwn), ElementsAre(own));
  EXPECT_THAT(Scenes("gus", Whose::kOwn), IsEmpty());
  EXPECT_THAT(Scenes("ada", Whose::kShared), ElementsAre(own, third));
  v1::ListScenesRequest both;
  both.set_own(true);
  both.set_shared(true);
  v1::ListScenesResponse response;
  EXPECT_EQ(CallScenes("bob", both, response, &Stub::ListScenes).error_code(), StatusCode::INVALID_ARGUMENT);
}

TEST_F(SceneSharingTest, EachOwnerSharesForItself) {
  ASSERT_EQ(Upload("cyd", "ada's"), name_) << "the same bytes";
  ASSERT_TRUE(Share("ada", name_, "user:bob").ok());
  ASSERT_TRUE(Read("bob", name_).ok());
  EXPECT_THAT(info_.owners(), ElementsAre("ada")) << "that cyd has it too is hers to tell";
  ASSERT_TRUE(Read("cyd", name_).ok());
  EXPECT_THAT(info_.owners(), ElementsAre("cyd"));
  EXPECT_THAT(info_.shares(), IsEmpty());
  ASSERT_TRUE(Read("gus", name_).ok());
  EXPECT_THAT(info_.owners(), ElementsAre("ada", "cyd"));
  ASSERT_TRUE(Remove("ada", name_).ok());
  ExpectHidden(Read("bob", name_), name_);
  EXPECT_TRUE(Read("cyd", name_).ok());
  EXPECT_FALSE(*database_->Prepare("SELECT 1 FROM grants").Step()) << "shares go with the upload";
  ASSERT_EQ(Upload("ada", "ada's"), name_);
  ExpectHidden(Read("bob", name_), name_);
}

TEST_F(SceneSharingTest, ControlTakesItFromThoseWhoGaveIt) {
  ASSERT_EQ(Upload("cyd", "ada's"), name_);
  ASSERT_TRUE(Share("ada", name_, "user:bob", v1::Share::CONTROL).ok());
  ASSERT_TRUE(Share("cyd", name_, "user:bob").ok());
  EXPECT_EQ(ReasonOf(Share("bob", name_, "user:gus")), "NOT_YOUR_SCENE");
  ASSERT_TRUE(Remove("bob", name_).ok());
  ExpectHidden(Read("ada", name_), name_);
  EXPECT_TRUE(Read("bob", name_).ok()) << "cyd's share remains";
  EXPECT_EQ(ReasonOf(Remove("bob", name_)), "NOT_YOUR_SCENE");
  EXPECT_TRUE(Read("cyd", name_).ok());
  // Of what is one's own too, only that goes.
  ASSERT_TRUE(Share("cyd", name_, "user:bob", v1::Share::CONTROL).ok());
  ASSERT_EQ(Upload("bob", "ada's"), name_);
  ASSERT_TRUE(Remove("bob", name_).ok());
  EXPECT_TRUE(Read("cyd", name_).ok());
}

TEST_F(SceneSharingTest, SharesOutliveTheServer) {
  ASSERT_TRUE(Share("ada", name_, "user:bob").ok());
  ASSERT_TRUE(Share("ada", name_, "group:x", v1::Share::CONTROL).ok());
  ASSERT_TRUE(Unshare("ada", name_, "group:x").ok());
  server_.reset();
  Start();
  EXPECT_TRUE(Read("bob", name_).ok());
  EXPECT_THAT(Scenes("bob", Whose::kShared), ElementsAre(name_));
  ASSERT_TRUE(Read("ada", name_).ok());
  EXPECT_EQ(info_.shares_size(), 1);
  ExpectHidden(Read("cyd", name_), name_);
}

TEST_F(SceneSharingTest, BadSharesAreRefused) {
  EXPECT_EQ(ReasonOf(Share("ada", "scenes/penumbra", "user:bob")), "GALLERY_SCENE");
  EXPECT_THAT(Share("ada", name_, "bob").error_message(), HasSubstr("user:NAME, group:NAME, course"));
  EXPECT_EQ(Share("ada", "scenes/", "user:bob").error_code(), StatusCode::INVALID_ARGUMENT);
  for (std::size_t i = 0; i < kMaxGrants; ++i) {
    ASSERT_TRUE(Share("ada", name_, "user:u" + std::to_string(i)).ok());
  }
  EXPECT_EQ(ReasonOf(Share("ada", name_, "user:bob")), "TOO_MANY_SHARES");
  ExpectHidden(Read("bob", name_), name_);
}

}  // namespace
}  // namespace flatlight
