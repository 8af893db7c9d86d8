// SPDX-License-Identifier: Apache-2.0
// Pausing, resuming and the class of a job, over loopback.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "tests/support/loopback/loopback_server.h"
#include "tests/support/rendering/fake_rendering.h"

namespace flatlight {
namespace {

using testing::FakeRenderings;
using testing::FloorAndLampProto;
using testing::LoopbackServer;
using testing::ReasonOf;
using testing::TestContext;

constexpr auto FAILED_PRECONDITION = grpc::StatusCode::FAILED_PRECONDITION;
constexpr auto INVALID_ARGUMENT = grpc::StatusCode::INVALID_ARGUMENT;

class ControlTest : public ::testing::Test {
 protected:
  ~ControlTest() override { renderings_.Release(); }

  ServerOptions Options() {
    ServerOptions options;
    options.start_rendering = [this](std::shared_ptr<const Scene> scene, const Plan& plan) {
      return renderings_.Start(scene, plan);
    };
    return options;
  }
  static v1::CreateJobRequest NewJob(v1::JobClass job_class) {
    v1::CreateJobRequest request;
    *request.mutable_scene()->mutable_scene() = FloorAndLampProto({10});
    request.mutable_settings()->set_method(v1::Settings::PATH_TRACING);
    request.set_job_class(job_class);
    return request;
  }

  // As it ended.
  static v1::Job WatchToTheEnd(LoopbackServer& server, const std::string& name) {
    v1::WatchJobRequest request;
    request.set_name(name);
    TestContext watching;
    const auto reader = server.render().WatchJob(&watching, request);
    v1::Job job;
    for (v1::WatchJobResponse message; reader->Read(&message);) {
      if (message.has_job()) job = message.job();
    }
    EXPECT_TRUE(reader->Finish().ok());
    return job;
  }

  FakeRenderings renderings_{1000};
};

TEST_F(ControlTest, AJobRestsAndGoesOn) {
  LoopbackServer server(Options());
  renderings_.Hold();
  v1::Job job;
  TestContext creating;
  ASSERT_TRUE(server.render().CreateJob(&creating, NewJob(v1::GRADED), &job).ok());
  EXPECT_EQ(job.job_class(), v1::GRADED);
  v1::PauseJobRequest pause;
  pause.set_name(job.name());
  std::atomic<bool> paused = false;
  std::thread allow([&] { renderings_.AllowUntil(paused); });
  TestContext pausing;
  EXPECT_TRUE(server.render().PauseJob(&pausing, pause, &job).ok());
  paused = true;
  allow.join();
  EXPECT_EQ(job.state(), v1::Job::PAUSED);
  renderings_.Release();
  v1::ResumeJobRequest resume;
  resume.set_name(job.name());
  TestContext resuming;
  EXPECT_TRUE(server.render().ResumeJob(&resuming, resume, &job).ok());
  EXPECT_EQ(WatchToTheEnd(server, job.name()).state(), v1::Job::SUCCEEDED);
  TestContext again;
  const grpc::Status status = server.render().PauseJob(&again, pause, &job);
  EXPECT_EQ(status.error_code(), FAILED_PRECONDITION);
  EXPECT_EQ(ReasonOf(status), "JOB_ENDED");
}

// Two watches of a job that is held up; the first ends in the middle. Returns the state that the second saw last.
v1::Job::State StateAfterTheFirstWatchEnds(LoopbackServer& server, FakeRenderings& renderings, const std::string& job,
                                           bool cancel_on_disconnect, std::chrono::milliseconds deadline) {
  v1::WatchJobRequest request;
  request.set_name(job);
  TestContext staying;
  const auto stays = server.render().WatchJob(&staying, request);
  request.set_cancel_on_disconnect(cancel_on_disconnect);
  grpc::ClientContext leaving;
  if (deadline.count() > 0) leaving.set_deadline(std::chrono::system_clock::now() + deadline);
  const auto leaves = server.render().WatchJob(&leaving, request);
  v1::WatchJobResponse message;
  leaves->Read(&message);
  if (deadline.count() == 0) leaving.TryCancel();
  const grpc::Status status = leaves->Finish();
  EXPECT_EQ(status.error_code(),
            deadline.count() > 0 ? grpc::StatusCode::DEADLINE_EXCEEDED : grpc::StatusCode::CANCELLED);
  // Who is not cancelled goes on once it may.
  if (!cancel_on_disconnect) renderings.Release();
  v1::WatchJobResponse last;
  while (stays->Read(&message)) {
    if (message.has_job()) last = message;
  }
  EXPECT_TRUE(stays->Finish().ok());
  return last.job().state();
}

TEST_F(ControlTest, AJobEndsWithTheWatchThatAsksForThat) {
  using std::chrono::milliseconds;
  LoopbackServer server(Options());
  struct Case {
    bool cancel_on_disconnect;
    milliseconds deadline;  // 0: the caller cancels the watch.
    v1::Job::State end;
  };
  for (const Case& c :
       {Case{true, milliseconds(0), v1::Job::CANCELLED}, Case{true, milliseconds(100), v1::Job::CANCELLED},
        Case{false, milliseconds(0), v1::Job::SUCCEEDED}}) {
    renderings_.Hold();
    v1::Job job;
    TestContext creating;
    ASSERT_TRUE(server.render().CreateJob(&creating, NewJob(v1::INTERACTIVE), &job).ok());
    EXPECT_EQ(StateAfterTheFirstWatchEnds(server, renderings_, job.name(), c.cancel_on_disconnect, c.deadline), c.end);
  }
}

TEST_F(ControlTest, EqualWorkIsSharedUnlessItIsToBeDoneAnew) {
  LoopbackServer server(Options());
  const auto shares = [&](const v1::CreateJobRequest& request) {
    v1::Job job;
    TestContext creating;
    EXPECT_TRUE(server.render().CreateJob(&creating, request, &job).ok());
    job = WatchToTheEnd(server, job.name());
    EXPECT_EQ(job.state(), v1::Job::SUCCEEDED);
    return job.shared_work();
  };
  v1::CreateJobRequest request = NewJob(v1::INTERACTIVE);
  EXPECT_FALSE(shares(request));
  EXPECT_TRUE(shares(request));
  request.set_job_class(v1::REGRADE);
  EXPECT_TRUE(shares(request));
  request.set_anew(true);
  EXPECT_FALSE(shares(request));
  request.set_anew(false);
  request.mutable_settings()->set_seed(1);
  EXPECT_FALSE(shares(request));
  request.mutable_settings()->set_time_limit(60);
  EXPECT_FALSE(shares(request));
  EXPECT_FALSE(shares(request));
}

TEST_F(ControlTest, AnUnknownClassIsRefused) {
  LoopbackServer server(Options());
  v1::Job job;
  TestContext context;
  const grpc::Status status = server.render().CreateJob(&context, NewJob(static_cast<v1::JobClass>(17)), &job);
  EXPECT_EQ(status.error_code(), INVALID_ARGUMENT);
  EXPECT_NE(status.error_message().find("allowed: INTERACTIVE, GRADED, REGRADE"), std::string::npos);
}

}  // namespace
}  // namespace flatlight
