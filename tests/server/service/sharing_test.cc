// SPDX-License-Identifier: Apache-2.0
// Jobs that are shared, over real connections of a class.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <thread>
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
using ::testing::Pair;
using testing::ReasonOf;
using testing::TestContext;

constexpr std::uint32_t kEndless = 1'000'000'000;  // Samples.

class SharingTest : public testing::ClassTest {
 protected:
  void SetUp() override {
    Start();
    AddClass();
  }
  grpc::Status Share(const std::string& user, const std::string& name, const std::string& grantee,
                     v1::Share::Access access = v1::Share::READ) {
    v1::ShareJobRequest request;
    request.set_name(name);
    request.mutable_share()->set_grantee(grantee);
    request.mutable_share()->set_access(access);
    return Call(user, request, answer_, &v1::RenderService::Stub::ShareJob);
  }
  grpc::Status Unshare(const std::string& user, const std::string& name, const std::string& grantee) {
    v1::UnshareJobRequest request;
    request.set_name(name);
    request.set_grantee(grantee);
    return Call(user, request, answer_, &v1::RenderService::Stub::UnshareJob);
  }
  // As GetJob tells them.
  std::map<std::string, v1::Share::Access> Shares(const std::string& user, const std::string& name) {
    v1::GetJobRequest request;
    request.set_name(name);
    EXPECT_TRUE(Call(user, request, answer_, &v1::RenderService::Stub::GetJob).ok());
    std::map<std::string, v1::Share::Access> shares;
    for (const v1::Share& share : answer_.shares()) shares[share.grantee()] = share.access();
    return shares;
  }
  double OpenWatches() {
    TestContext context;
    Identify("ina", context);
    v1::GetActivityResponse activity;
    EXPECT_TRUE(server_->info().GetActivity(&context, v1::GetActivityRequest(), &activity).ok());
    return activity.watches();
  }

  v1::Job answer_;
};

TEST_F(SharingTest, ReadersSeeAndChangeNothing) {
  const std::string job = Create("ada").name();
  ASSERT_TRUE(Share("ada", job, "user:bob").ok());
  EXPECT_EQ(answer_.owner(), "ada");
  EXPECT_TRUE(Watch("bob", job).ok());
  EXPECT_TRUE(Fetch("bob", job).ok());
  EXPECT_TRUE(Get("bob", job).ok());
  EXPECT_THAT(List("bob"), IsEmpty());
  EXPECT_THAT(List("bob", true), ElementsAre(job));
  for (const grpc::Status& refused :
       {Watch("bob", job, true), Cancel("bob", job), Pause("bob", job), Resume("bob", job), Delete("bob", job),
        Share("bob", job, "user:cyd"), Unshare("bob", job, "user:bob")}) {
    EXPECT_EQ(refused.error_code(), StatusCode::PERMISSION_DENIED);
    EXPECT_EQ(ReasonOf(refused), "NOT_YOUR_JOB");
  }
  EXPECT_EQ(Get("cyd", job).error_code(), StatusCode::NOT_FOUND);
  EXPECT_EQ(Share("cyd", job, "user:cyd").error_code(), StatusCode::NOT_FOUND);
  EXPECT_THAT(List("cyd", true), IsEmpty());
  EXPECT_THAT(List("ada", true), IsEmpty());
}

TEST_F(SharingTest, ControlEndsBeforeDeletingAndSharing) {
  const std::string job = Create("ada", kEndless).name();
  ASSERT_TRUE(Share("ada", job, "user:bob", v1::Share::CONTROL).ok());
  ASSERT_TRUE(Share("ada", job, "user:gus", v1::Share::CONTROL).ok());
  EXPECT_TRUE(Pause("bob", job).ok());
  EXPECT_TRUE(Resume("gus", job).ok()) << "as a grader he could only watch";
  EXPECT_EQ(ReasonOf(Share("bob", job, "user:cyd")), "NOT_YOUR_JOB");
  EXPECT_EQ(ReasonOf(Delete("bob", job)), "NOT_YOUR_JOB");
  EXPECT_TRUE(Cancel("bob", job).ok());
  EXPECT_EQ(ReasonOf(Delete("gus", job)), "NOT_YOUR_JOB");
  EXPECT_TRUE(Delete("ada", job).ok());
}

TEST_F(SharingTest, GroupsAndTheCourse) {
  const std::string first = Create("ada").name();
  const std::string second = Create("ada").name();
  ASSERT_TRUE(Share("ada", first, "group:lab-1").ok());
  EXPECT_TRUE(Get("bob", first).ok());
  EXPECT_EQ(Get("cyd", first).error_code(), StatusCode::NOT_FOUND);
  ASSERT_TRUE(Share("ada", first, "group:cyd").ok());
  ASSERT_TRUE(Share("ada", first, "user:lab-1").ok());
  EXPECT_EQ(Get("cyd", first).error_code(), StatusCode::NOT_FOUND) << "a group is no user of the same name";
  ASSERT_TRUE(Share("ina", second, "course").ok()) << "instructors share everybody's";
  EXPECT_TRUE(Get("cyd", second).ok());
  EXPECT_THAT(List("cyd", true), ElementsAre(second));
  EXPECT_THAT(List("bob", true), ElementsAre(second, first));
  EXPECT_THAT(List("ada", true), IsEmpty()) << "it is her own";
  // Both of what bob is count: the more that is allowed.
  ASSERT_TRUE(Share("ada", first, "course", v1::Share::CONTROL).ok());
  EXPECT_TRUE(Cancel("bob", first).ok());
}

TEST_F(SharingTest, ListsComeInPages) {
  std::vector<std::string> made;
  for (int i = 0; i < 3; ++i) {
    made.insert(made.begin(), Create("ada").name());
    ASSERT_TRUE(Share("ada", made.front(), "course").ok());
    ASSERT_TRUE(Share("ada", made.front(), "user:bob").ok());
    Create("ada");
  }
  v1::ListJobsRequest request;
  request.set_shared(true);
  request.set_page_size(1);
  std::vector<std::string> listed;
  do {
    v1::ListJobsResponse page;
    ASSERT_TRUE(Call("bob", request, page, &v1::RenderService::Stub::ListJobs).ok());
    ASSERT_EQ(page.jobs_size(), 1);
    listed.push_back(page.jobs(0).name());
    EXPECT_EQ(page.jobs(0).owner(), "ada");
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty());
  EXPECT_EQ(listed, made);
}

TEST_F(SharingTest, SharesAreTold) {
  const std::string job = Create("ada").name();
  ASSERT_TRUE(Share("ada", job, "user:bob", v1::Share::CONTROL).ok());
  ASSERT_TRUE(Share("ada", job, "course").ok());
  ASSERT_TRUE(Share("ada", job, "user:bob").ok());
  EXPECT_EQ(answer_.shares_size(), 2);
  for (const char* user : {"ada", "ina"}) {
    EXPECT_THAT(Shares(user, job), ElementsAre(Pair("course", v1::Share::READ), Pair("user:bob", v1::Share::READ)));
  }
  for (const char* user : {"bob", "cyd", "gus"}) EXPECT_THAT(Shares(user, job), IsEmpty()) << user;
  EXPECT_EQ(ReasonOf(Cancel("bob", job)), "NOT_YOUR_JOB") << "the later share replaces the earlier one";
  ASSERT_TRUE(Unshare("ada", job, "course").ok());
  EXPECT_EQ(answer_.shares_size(), 1);
}

TEST_F(SharingTest, BadSharesAreRefused) {
  const std::string job = Create("ada").name();
  for (const char* bad : {"", "bob", "user:", "user:Bob", "user:anonymous", "group:", "course:", "courses", "role:x"}) {
    EXPECT_EQ(Share("ada", job, bad).error_code(), StatusCode::INVALID_ARGUMENT) << bad;
    EXPECT_EQ(Unshare("ada", job, bad).error_code(), StatusCode::INVALID_ARGUMENT) << bad;
  }
  EXPECT_THAT(Share("ada", job, "bob").error_message(), HasSubstr("user:NAME, group:NAME, course"));
  EXPECT_EQ(Share("ada", job, "user:bob", static_cast<v1::Share::Access>(7)).error_code(),
            StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(ReasonOf(Unshare("ada", job, "user:bob")), "SHARE_NOT_FOUND");
  for (std::size_t i = 0; i < kMaxGrants; ++i) {
    ASSERT_TRUE(Share("ada", job, "user:u" + std::to_string(i)).ok());
  }
  const grpc::Status refused = Share("ada", job, "user:bob");
  EXPECT_EQ(refused.error_code(), StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(ReasonOf(refused), "TOO_MANY_SHARES");
  EXPECT_TRUE(Share("ada", job, "user:u0", v1::Share::CONTROL).ok()) << "it makes none more";
}

TEST_F(SharingTest, WithTheShareItsWatchesEnd) {
  const std::string job = Create("ada", kEndless).name();
  ASSERT_TRUE(Share("ada", job, "user:bob").ok());
  ASSERT_TRUE(Share("ada", job, "group:lab-1").ok());
  v1::WatchJobRequest request;
  request.set_name(job);
  TestContext context, own_context;
  Identify("bob", context);
  Identify("ada", own_context);
  const auto watch = server_->render().WatchJob(&context, request);
  const auto own = server_->render().WatchJob(&own_context, request);
  v1::WatchJobResponse update;
  ASSERT_TRUE(watch->Read(&update));
  ASSERT_TRUE(own->Read(&update));
  ASSERT_TRUE(Unshare("ada", job, "user:bob").ok());
  ASSERT_TRUE(Get("bob", job).ok()) << "he is in the group";
  const std::uint64_t sequence = update.sequence();
  do {
    ASSERT_TRUE(watch->Read(&update));
  } while (update.sequence() < sequence + 3);
  ASSERT_TRUE(Unshare("ada", job, "group:lab-1").ok());
  while (watch->Read(&update)) continue;
  const grpc::Status ended = watch->Finish();
  EXPECT_EQ(ended.error_code(), StatusCode::NOT_FOUND);
  EXPECT_EQ(ended.error_message(), Get("bob", job).error_message());
  EXPECT_TRUE(own->Read(&update));
  ASSERT_TRUE(Cancel("ada", job).ok());
  while (own->Read(&update)) continue;
  EXPECT_TRUE(own->Finish().ok());
}

TEST_F(SharingTest, WhoLostControlCancelsNothingByLeaving) {
  const std::string job = Create("ada", kEndless).name();
  ASSERT_TRUE(Share("ada", job, "user:bob", v1::Share::CONTROL).ok());
  v1::WatchJobRequest request;
  request.set_name(job);
  request.set_cancel_on_disconnect(true);
  {
    TestContext context;
    Identify("bob", context);
    const auto watch = server_->render().WatchJob(&context, request);
    v1::WatchJobResponse update;
    ASSERT_TRUE(watch->Read(&update));
    ASSERT_TRUE(Share("ada", job, "user:bob").ok());
    context.TryCancel();
    while (watch->Read(&update)) continue;
    watch->Finish();
  }
  while (OpenWatches() > 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_TRUE(Pause("ada", job).ok()) << "it has not ended";
}

TEST_F(SharingTest, SharesOutliveTheServerAndEndWithTheJob) {
  const std::string job = Create("ada").name();
  ASSERT_TRUE(Share("ada", job, "user:bob").ok());
  ASSERT_TRUE(Watch("ada", job).ok());
  server_.reset();
  Start();
  EXPECT_TRUE(Get("bob", job).ok());
  EXPECT_THAT(List("bob", true), ElementsAre(job));
  ASSERT_TRUE(Delete("ada", job).ok());
  EXPECT_THAT(List("bob", true), IsEmpty());
  EXPECT_FALSE(*database_->Prepare("SELECT 1 FROM grants").Step());
}

TEST_F(SharingTest, TheAuditLogSaysWithWhom) {
  const std::string job = Create("ada").name();
  ASSERT_TRUE(Share("ada", job, "group:lab-1", v1::Share::CONTROL).ok());
  ASSERT_TRUE(Unshare("ada", job, "group:lab-1").ok());
  server_.reset();
  std::ifstream file(folder_.path() + "/data/audit.jsonl");
  const std::string log{std::istreambuf_iterator<char>(file), {}};
  EXPECT_THAT(log, HasSubstr("\"grantee\":\"group:lab-1 control\""));
  EXPECT_THAT(log, HasSubstr("\"grantee\":\"group:lab-1\""));
}

}  // namespace
}  // namespace flatlight
