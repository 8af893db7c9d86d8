// SPDX-License-Identifier: Apache-2.0
// Lists in pages, of several users, while things come and go.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/support/loopback/class_test.h"
#include "tests/support/loopback/loopback_server.h"

namespace flatlight {
namespace {

using grpc::StatusCode;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct NamePage {
  std::vector<std::string> names;
  std::string next;
};

class ListsTest : public testing::ClassTest {
 protected:
  void SetUp() override {
    Start();
    AddClass();
  }
  grpc::Status ReadPage(const std::string& user, int size, const std::string& token, NamePage& page,
                        bool shared = false) {
    v1::ListJobsRequest request;
    request.set_page_size(size);
    request.set_page_token(token);
    request.set_shared(shared);
    v1::ListJobsResponse response;
    grpc::Status status = Call(user, request, response, &v1::RenderService::Stub::ListJobs);
    page = {{}, response.next_page_token()};
    for (const v1::Job& job : response.jobs()) page.names.push_back(job.name());
    return status;
  }
  NamePage Page(const std::string& user, int size, const std::string& token = "", bool shared = false) {
    NamePage page;
    const grpc::Status status = ReadPage(user, size, token, page, shared);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return page;
  }
  void ExpectRefused(const std::string& user, const std::string& token, bool shared = false) {
    NamePage page;
    const grpc::Status status = ReadPage(user, 2, token, page, shared);
    EXPECT_EQ(status.error_code(), StatusCode::INVALID_ARGUMENT) << user << ' ' << token;
    EXPECT_THAT(status.error_message(), HasSubstr("page_token"));
  }
  // Newest first.
  std::vector<std::string> CreateMany(const std::string& user, int count) {
    std::vector<std::string> names;
    for (int i = 0; i < count; ++i) names.insert(names.begin(), Create(user, 1).name());
    return names;
  }
  void Share(const std::string& user, const std::string& name, const std::string& grantee) {
    v1::ShareJobRequest request;
    request.set_name(name);
    request.mutable_share()->set_grantee(grantee);
    v1::Job answer;
    ASSERT_TRUE(Call(user, request, answer, &v1::RenderService::Stub::ShareJob).ok());
  }
};

TEST_F(ListsTest, PagesAreFullHoweverManyJobsOthersHave) {
  std::vector<std::string> ada, bob, all;
  for (int i = 0; i < 5; ++i) {
    for (const std::string& name : CreateMany("bob", 4)) all.push_back(name), bob.push_back(name);
    ada.insert(ada.begin(), Create("ada", 1).name());
    all.push_back(ada.front());
  }
  CreateMany("bob", 4);
  const NamePage first = Page("ada", 2);
  EXPECT_THAT(first.names, ElementsAre(ada[0], ada[1]));
  const NamePage second = Page("ada", 2, first.next);
  EXPECT_THAT(second.names, ElementsAre(ada[2], ada[3]));
  const NamePage third = Page("ada", 2, second.next);
  EXPECT_THAT(third.names, ElementsAre(ada[4]));
  EXPECT_EQ(third.next, "");
  EXPECT_EQ(Page("ada", 5).next, "") << "no page follows that would be empty";
  EXPECT_EQ(Page("gus", 29).names.size(), 29u) << "graders see all";
  EXPECT_EQ(Page("gus", 29).next, "");
  const std::string grader = Create("gus", 1).name();
  v1::ListJobsRequest own;
  own.set_own(true);
  v1::ListJobsResponse response;
  ASSERT_TRUE(Call("gus", own, response, &v1::RenderService::Stub::ListJobs).ok());
  ASSERT_EQ(response.jobs_size(), 1) << "unless it wants its own";
  EXPECT_EQ(response.jobs(0).name(), grader);
  own.set_shared(true);
  EXPECT_EQ(Call("gus", own, response, &v1::RenderService::Stub::ListJobs).error_code(), StatusCode::INVALID_ARGUMENT);
  EXPECT_THAT(Page("cyd", 1).names, IsEmpty());
  EXPECT_EQ(Page("cyd", 1).next, "") << "nothing tells of others' jobs";
}

TEST_F(ListsTest, JobsComeAndGoBetweenPages) {
  const std::vector<std::string> ada = CreateMany("ada", 7);
  for (const std::string& name : ada) ASSERT_TRUE(Watch("ada", name).ok());
  const NamePage first = Page("ada", 2);
  ASSERT_THAT(first.names, ElementsAre(ada[0], ada[1]));
  CreateMany("ada", 2);
  CreateMany("bob", 2);
  ASSERT_TRUE(Delete("ada", ada[1]).ok()) << "where the next page begins";
  ASSERT_TRUE(Delete("ada", ada[3]).ok()) << "one that comes later";
  const NamePage second = Page("ada", 2, first.next);
  EXPECT_THAT(second.names, ElementsAre(ada[2], ada[4]));
  for (const std::string& name : {ada[5], ada[6]}) ASSERT_TRUE(Delete("ada", name).ok());
  const NamePage third = Page("ada", 2, second.next);
  EXPECT_THAT(third.names, IsEmpty());
  EXPECT_EQ(third.next, "");
  EXPECT_EQ(Page("ada", 9).names.size(), 5u);
}

TEST_F(ListsTest, WhatIsSharedComesInFullPagesToo) {
  std::vector<std::string> shared;
  for (int i = 0; i < 3; ++i) {
    shared.insert(shared.begin(), Create("ada", 1).name());
    Share("ada", shared.front(), "user:bob");
    Share("ada", shared.front(), "group:lab-1");
    const std::string other = Create("ada", 1).name();
    Share("ada", other, "user:cyd");
    Share("bob", Create("bob", 1).name(), "course");
  }
  const NamePage first = Page("bob", 2, "", true);
  EXPECT_THAT(first.names, ElementsAre(shared[0], shared[1]));
  ASSERT_TRUE(Watch("ada", shared[1]).ok());
  ASSERT_TRUE(Delete("ada", shared[1]).ok());
  const NamePage second = Page("bob", 2, first.next, true);
  EXPECT_THAT(second.names, ElementsAre(shared[2]));
  EXPECT_EQ(second.next, "");
  ExpectRefused("bob", first.next);
  ExpectRefused("cyd", first.next, true);
}

TEST_F(ListsTest, ATokenIsGoodForWhomItWasGiven) {
  CreateMany("ada", 3);
  CreateMany("bob", 3);
  const std::string token = Page("ada", 2).next;
  EXPECT_EQ(Page("ada", 1, token).names.size(), 1u) << "the size of pages may change";
  ExpectRefused("bob", token);
  ExpectRefused("gus", token);
  ExpectRefused("ada", token, true);
  ExpectRefused("ada", token.substr(1));
  ExpectRefused("ada", "p3");
  server_.reset();
  Start();
  ExpectRefused("ada", token);
}

TEST_F(ListsTest, RoomsComeInPagesToo) {
  std::vector<std::string> made;
  const auto call = [&](const std::string& user, const auto& request, auto& response, auto rpc) {
    testing::TestContext context;
    Identify(user, context);
    return (server_->review().*rpc)(&context, request, &response);
  };
  for (int i = 0; i < 5; ++i) {
    v1::CreateRoomRequest create;
    create.set_title("lab");
    v1::Room room;
    ASSERT_TRUE(call("ina", create, room, &v1::ReviewService::Stub::CreateRoom).ok());
    if (i % 2 == 1) continue;
    made.insert(made.begin(), room.name());
    v1::ShareRoomRequest share;
    share.set_name(room.name());
    share.mutable_share()->set_grantee("user:bob");
    ASSERT_TRUE(call("ina", share, room, &v1::ReviewService::Stub::ShareRoom).ok());
  }
  v1::ListRoomsRequest request;
  request.set_page_size(2);
  v1::ListRoomsResponse page;
  ASSERT_TRUE(call("bob", request, page, &v1::ReviewService::Stub::ListRooms).ok());
  ASSERT_EQ(page.rooms_size(), 2);
  EXPECT_EQ(page.rooms(1).name(), made[1]);
  request.set_page_token(page.next_page_token());
  EXPECT_EQ(call("cyd", request, page, &v1::ReviewService::Stub::ListRooms).error_code(), StatusCode::INVALID_ARGUMENT);
  ASSERT_TRUE(call("bob", request, page, &v1::ReviewService::Stub::ListRooms).ok());
  ASSERT_EQ(page.rooms_size(), 1);
  EXPECT_EQ(page.rooms(0).name(), made[2]);
  EXPECT_EQ(page.next_page_token(), "");
}

class SceneListsTest : public ListsTest {
 protected:
  // The names of one page.
  NamePage Scenes(const std::string& user, int size, const std::string& token = "") {
    v1::ListScenesRequest request;
    request.set_page_size(size);
    request.set_page_token(token);
    v1::ListScenesResponse response;
    const grpc::Status status = CallScenes(user, request, response, &v1::SceneService::Stub::ListScenes);
    EXPECT_TRUE(status.ok()) << status.error_message();
    NamePage page{{}, response.next_page_token()};
    for (const v1::SceneInfo& scene : response.scenes()) page.names.push_back(scene.name());
    return page;
  }
};

TEST_F(SceneListsTest, PagesOfScenesAreFullAndEndWithTheLast) {
  const int gallery = static_cast<int>(Scenes("ada", 1000).names.size());
  std::vector<std::string> all = Scenes("ada", 1000).names;
  std::vector<std::string> uploaded;
  for (int i = 0; i < 3; ++i) {
    Upload("bob", "bob's " + std::to_string(i));
    uploaded.insert(uploaded.begin(), Upload("ada", "ada's " + std::to_string(i)));
  }
  all.insert(all.end(), uploaded.begin(), uploaded.end());
  for (const int size : {1, 2, gallery - 1, gallery, gallery + 1, gallery + 3}) {
    std::vector<std::string> listed;
    std::string token;
    do {
      const NamePage page = Scenes("ada", size, token);
      EXPECT_EQ(page.names.size(), std::min<std::size_t>(static_cast<std::size_t>(size), all.size() - listed.size()))
          << size;
      ASSERT_FALSE(page.names.empty());
      listed.insert(listed.end(), page.names.begin(), page.names.end());
      token = page.next;
    } while (!token.empty());
    EXPECT_EQ(listed, all) << size;
  }
  EXPECT_EQ(Scenes("cyd", gallery).next, "");
  v1::ListScenesRequest request;
  request.set_page_token(Scenes("ada", 1).next);
  v1::ListScenesResponse response;
  EXPECT_EQ(CallScenes("bob", request, response, &v1::SceneService::Stub::ListScenes).error_code(),
            StatusCode::INVALID_ARGUMENT);
}

}  // namespace
}  // namespace flatlight
