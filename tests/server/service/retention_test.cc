// SPDX-License-Identifier: Apache-2.0
// Jobs that have ended go when their time is over, by a clock that is set.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include "tests/support/loopback/class_test.h"
#include "tests/support/loopback/loopback_server.h"

namespace flatlight {
namespace {

using grpc::StatusCode;
using testing::TestContext;

class RetentionServiceTest : public testing::ClassTest {
 protected:
  void SetUp() override {
    Restart("interactive=1h");
    AddClass();
  }
  void Restart(const std::string& keep) {
    server_.reset();
    ServerOptions options;
    EXPECT_TRUE(options.retention.Set(keep).ok());
    options.retention_interval = std::chrono::milliseconds(10);
    options.retention_clock = [this] { return std::chrono::system_clock::now() + ahead_.load(); };
    Start(options);
  }
  v1::Job GetIt(const std::string& name) {
    v1::GetJobRequest request;
    request.set_name(name);
    v1::Job job;
    EXPECT_TRUE(Call("ada", request, job, &v1::RenderService::Stub::GetJob).ok());
    return job;
  }
  std::string Ended(v1::JobClass job_class = v1::INTERACTIVE, std::uint32_t samples = 16) {
    v1::CreateJobRequest request;
    *request.mutable_scene()->mutable_scene() = testing::FloorAndLampProto({4});
    request.mutable_settings()->set_method(v1::Settings::PATH_TRACING);
    request.mutable_settings()->set_samples(samples);
    request.set_job_class(job_class);
    v1::Job job;
    EXPECT_TRUE(Call("ada", request, job, &v1::RenderService::Stub::CreateJob).ok());
    EXPECT_TRUE(Watch("ada", job.name()).ok());
    return job.name();
  }
  bool IsThere(const std::string& name) { return Get("ada", name).ok(); }
  void AwaitGone(const std::string& name) {
    while (IsThere(name)) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  // The sweeper has looked since at all that ended before: one that ends now, and has expired by the clock that was
  // set, is gone.
  void AwaitSweep() { AwaitGone(Create("ada", ++samples_).name()); }

  std::atomic<std::chrono::seconds> ahead_{std::chrono::seconds(0)};
  std::uint32_t samples_ = 100;
};

TEST_F(RetentionServiceTest, AJobGoesWhenItsTimeIsOver) {
  const std::string job = Ended(), graded = Ended(v1::GRADED, 17);
  const v1::Job shown = GetIt(job);
  EXPECT_EQ(shown.expire_time().seconds(), shown.end_time().seconds() + 3600);
  EXPECT_EQ(shown.expire_time().nanos(), shown.end_time().nanos());
  EXPECT_FALSE(GetIt(graded).has_expire_time());
  ahead_ = std::chrono::minutes(59);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_TRUE(IsThere(job));
  ahead_ = std::chrono::minutes(61);
  AwaitGone(job);
  EXPECT_EQ(Fetch("ada", job).error_code(), StatusCode::NOT_FOUND);
  ahead_ = std::chrono::hours(24 * 3650);
  AwaitSweep();
  EXPECT_TRUE(IsThere(graded));
  std::ifstream file(folder_.path() + "/data/audit.jsonl");
  const std::string audit{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(audit.find(R"("removed":"expired","caller":"ada","resource":")" + job), std::string::npos) << audit;
}

TEST_F(RetentionServiceTest, WhatExpiredWhileNoServerRanGoesWhenOneDoes) {
  const std::string job = Ended(), graded = Ended(v1::GRADED, 17), later = Ended(v1::REGRADE, 18);
  server_.reset();
  ahead_ = std::chrono::hours(2);
  Restart("interactive=1h");
  AwaitGone(job);
  EXPECT_TRUE(IsThere(graded));
  // What a server is told now counts, also for jobs that ended before.
  Restart("graded=3h");
  EXPECT_EQ(GetIt(graded).expire_time().seconds(), GetIt(graded).end_time().seconds() + 3 * 3600);
  ahead_ = std::chrono::hours(4);
  AwaitGone(graded);
  EXPECT_TRUE(IsThere(later));
}

TEST_F(RetentionServiceTest, AJobThatARoomShowsStays) {
  const std::string job = Ended();
  v1::CreateRoomRequest create;
  create.set_title("Lab");
  v1::Room room;
  TestContext create_context;
  Identify("ina", create_context);
  ASSERT_TRUE(server_->review().CreateRoom(&create_context, create, &room).ok());
  v1::LookAtRequest look;
  look.set_name(room.name());
  look.set_job(job);
  TestContext look_context;
  Identify("ina", look_context);
  const grpc::Status looked = server_->review().LookAt(&look_context, look, &room);
  ASSERT_TRUE(looked.ok()) << looked.error_message();
  ahead_ = std::chrono::hours(2);
  AwaitSweep();
  EXPECT_TRUE(IsThere(job));
  v1::CloseRoomRequest close;
  close.set_name(room.name());
  TestContext close_context;
  Identify("ina", close_context);
  ASSERT_TRUE(server_->review().CloseRoom(&close_context, close, &room).ok());
  AwaitGone(job);
}

TEST_F(RetentionServiceTest, CapabilitiesAnnounceIt) {
  TestContext context;
  Identify("ada", context);
  v1::GetCapabilitiesResponse response;
  ASSERT_TRUE(server_->info().GetCapabilities(&context, v1::GetCapabilitiesRequest(), &response).ok());
  ASSERT_EQ(response.retention_size(), 3);
  EXPECT_EQ(response.retention(0).job_class(), v1::INTERACTIVE);
  EXPECT_EQ(response.retention(0).keep_seconds(), 3600);
  EXPECT_FALSE(response.retention(1).has_keep_seconds());
  EXPECT_EQ(response.retention(2).job_class(), v1::REGRADE);
}

}  // namespace
}  // namespace flatlight
