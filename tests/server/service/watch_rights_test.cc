// SPDX-License-Identifier: Apache-2.0
// Watches end when those who watch cease to be users, over real connections of a class.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "server/store/user_store.h"
#include "tests/support/loopback/class_test.h"
#include "tests/support/loopback/loopback_server.h"

namespace flatlight {
namespace {

using grpc::StatusCode;
using testing::ReasonOf;
using testing::TestContext;

constexpr std::uint32_t kEndless = 1'000'000'000;  // Samples.

class WatchRightsTest : public testing::ClassTest {
 protected:
  // A WatchJob stream of somebody who has had its first message.
  struct Watching {
    Watching(WatchRightsTest& test, const std::string& user, const std::string& job,
             bool cancel_on_disconnect = false) {
      test.Identify(user, context);
      v1::WatchJobRequest request;
      request.set_name(job);
      request.set_cancel_on_disconnect(cancel_on_disconnect);
      stream = test.server_->render().WatchJob(&context, request);
      v1::WatchJobResponse update;
      EXPECT_TRUE(stream->Read(&update));
    }
    grpc::Status ReadToEnd() {
      v1::WatchJobResponse update;
      while (stream->Read(&update)) continue;
      return stream->Finish();
    }
    TestContext context;
    std::unique_ptr<grpc::ClientReader<v1::WatchJobResponse>> stream;
  };

  void SetUp() override { Start(); }
  // Of `owner`, on which nothing happens.
  std::string RestingJob(const std::string& owner) {
    std::string job = Create(owner, kEndless).name();
    EXPECT_TRUE(Pause(owner, job).ok());
    return job;
  }
  void Revoke(const std::string& user) { ASSERT_TRUE(UserStore(*database_).Revoke(user).ok()); }
  void AwaitNoWatches() {
    double open = 1;
    while (open > 0) {
      TestContext context;
      Identify("ina", context);
      v1::GetActivityResponse activity;
      ASSERT_TRUE(server_->info().GetActivity(&context, v1::GetActivityRequest(), &activity).ok());
      open = activity.watches();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
};

TEST_F(WatchRightsTest, WithTheTokenTheWatchesEnd) {
  AddClass();
  const std::string job = Create("ada", kEndless).name();
  const std::string resting = RestingJob("ada");
  Watching running(*this, "ada", job), idle(*this, "ada", resting), others(*this, "gus", resting);
  Revoke("ada");
  for (Watching* watch : {&running, &idle}) {
    const grpc::Status ended = watch->ReadToEnd();
    EXPECT_EQ(ended.error_code(), StatusCode::UNAUTHENTICATED) << ended.error_message();
    EXPECT_EQ(ReasonOf(ended), "TOKEN_INVALID");
  }
  ASSERT_TRUE(Cancel("ina", resting).ok());
  EXPECT_TRUE(others.ReadToEnd().ok()) << "a grader's goes on to the end of the job";
}

TEST_F(WatchRightsTest, ANewTokenIsForNewWatches) {
  AddClass();
  Watching watch(*this, "ada", RestingJob("ada"));
  Revoke("ada");
  ASSERT_TRUE(UserStore(*database_).Add({{"ada", Role::kStudent, {}}}).ok());
  EXPECT_EQ(ReasonOf(watch.ReadToEnd()), "TOKEN_INVALID");
}

TEST_F(WatchRightsTest, WithTheUserTheWatchesEnd) {
  AddClass();
  Watching watch(*this, "ada", RestingJob("ada"));
  ASSERT_TRUE(database_->Execute("DELETE FROM users WHERE name = 'ada'").ok());
  EXPECT_EQ(watch.ReadToEnd().error_code(), StatusCode::UNAUTHENTICATED);
}

TEST_F(WatchRightsTest, WithAnotherRoleTheWatchesEnd) {
  AddClass();
  Watching watch(*this, "gus", RestingJob("ada"));
  ASSERT_TRUE(database_->Execute("UPDATE users SET role = 'student' WHERE name = 'gus'").ok());
  const grpc::Status ended = watch.ReadToEnd();
  EXPECT_EQ(ended.error_code(), StatusCode::PERMISSION_DENIED);
  EXPECT_EQ(ReasonOf(ended), "RIGHTS_CHANGED");
}

TEST_F(WatchRightsTest, WithTheFirstUserThoseOfEverybodyEnd) {
  const std::string job = RestingJob("");
  Watching watch(*this, "", job);
  AddClass();
  const grpc::Status ended = watch.ReadToEnd();
  EXPECT_EQ(ended.error_code(), StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(ReasonOf(ended), "BAD_TOKEN");
  EXPECT_TRUE(Get("ina", job).ok());
}

TEST_F(WatchRightsTest, WhoLostTheTokenCancelsNothingByLeaving) {
  AddClass();
  const std::string job = RestingJob("ada");
  Watching watch(*this, "ada", job, true);
  Revoke("ada");
  watch.context.TryCancel();
  watch.ReadToEnd();
  AwaitNoWatches();
  EXPECT_TRUE(Resume("ina", job).ok()) << "it has not ended";
}

TEST_F(WatchRightsTest, WhoIsSentAwayCancelsNothingEither) {
  AddClass();
  const std::string job = RestingJob("ada");
  Watching watch(*this, "ada", job, true);
  Revoke("ada");
  EXPECT_EQ(ReasonOf(watch.ReadToEnd()), "TOKEN_INVALID");
  AwaitNoWatches();
  EXPECT_TRUE(Resume("ina", job).ok()) << "it has not ended";
}

TEST_F(WatchRightsTest, WithTheTokenWatchesOfRoomsEnd) {
  AddClass();
  TestContext context;
  Identify("ina", context);
  v1::CreateRoomRequest create;
  create.set_title("Lab 3");
  v1::Room room;
  ASSERT_TRUE(server_->review().CreateRoom(&context, create, &room).ok());
  TestContext share_context;
  Identify("ina", share_context);
  v1::ShareRoomRequest share;
  share.set_name(room.name());
  share.mutable_share()->set_grantee("course");
  share.mutable_share()->set_access(v1::Share::READ);
  ASSERT_TRUE(server_->review().ShareRoom(&share_context, share, &room).ok());
  TestContext watch_context;
  Identify("bob", watch_context);
  v1::WatchRoomRequest request;
  request.set_name(room.name());
  const auto watch = server_->review().WatchRoom(&watch_context, request);
  v1::WatchRoomResponse update;
  ASSERT_TRUE(watch->Read(&update));
  Revoke("bob");
  while (watch->Read(&update)) continue;
  EXPECT_EQ(ReasonOf(watch->Finish()), "TOKEN_INVALID");
}

}  // namespace
}  // namespace flatlight
