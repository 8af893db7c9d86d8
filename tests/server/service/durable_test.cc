// SPDX-License-Identifier: Apache-2.0
// Servers one after the other on one folder: what was accepted is there, and ends with the same bits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "core/render/rendering.h"
#include "server/store/sha256.h"
#include "tests/support/loopback/loopback_server.h"
#include "tests/support/rendering/fake_rendering.h"
#include "tests/support/status/status_matchers.h"
#include "tests/support/status/temporary_folder.h"

namespace flatlight {
namespace {

using grpc::StatusCode;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using testing::LoopbackServer;
using testing::TestContext;

class DurableTest : public ::testing::Test {
 protected:
  ServerOptions Options() {
    ServerOptions options;
    options.data = folder_.path() + "/data";
    options.threads = 2;
    options.checkpoint_interval = std::chrono::milliseconds(0);
    return options;
  }
  void Restart(const ServerOptions& options) {
    server_.reset();
    server_ = std::make_unique<LoopbackServer>(options);
  }
  v1::CreateJobRequest Request(std::uint32_t samples) {
    v1::CreateJobRequest request;
    *request.mutable_scene()->mutable_scene() = testing::FloorAndLampProto({40});
    request.mutable_settings()->set_method(v1::Settings::PATH_TRACING);
    request.mutable_settings()->set_samples(samples);
    return request;
  }
  v1::Job Create(const v1::CreateJobRequest& request) {
    TestContext context;
    v1::Job job;
    const grpc::Status status = server_->render().CreateJob(&context, request, &job);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return job;
  }
  v1::Job Get(const std::string& name) {
    TestContext context;
    v1::GetJobRequest request;
    request.set_name(name);
    v1::Job job;
    const grpc::Status status = server_->render().GetJob(&context, request, &job);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return job;
  }
  template <typename Request>
  v1::Job Control(grpc::Status (v1::RenderService::Stub::*call)(grpc::ClientContext*, const Request&, v1::Job*),
                  Request request, const std::string& name) {
    TestContext context;
    request.set_name(name);
    v1::Job job;
    const grpc::Status status = (server_->render().*call)(&context, request, &job);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return job;
  }
  // All that a watcher hears, put together: the last job, and the values of the first probe.
  struct Watched {
    v1::Job job;
    v1::ProbeResult probe;
  };
  Watched Watch(const std::string& name) {
    TestContext context;
    v1::WatchJobRequest request;
    request.set_name(name);
    const auto reader = server_->render().WatchJob(&context, request);
    Watched watched;
    for (v1::WatchJobResponse update; reader->Read(&update);) {
      if (update.has_job()) watched.job.MergeFrom(update.job());
      for (const v1::FieldUpdate& points : update.updates()) {
        if (points.points().positions_size() > 0) {
          watched.probe = points.points();
        } else if (points.points().irradiance_size() > 0) {
          *watched.probe.mutable_irradiance() = points.points().irradiance();
        }
      }
    }
    const grpc::Status status = reader->Finish();
    EXPECT_TRUE(status.ok()) << status.error_message();
    return watched;
  }
  // The result of a server that was never interrupted.
  std::string RenderWithoutAFolder(std::uint32_t samples) {
    server_ = std::make_unique<LoopbackServer>();
    const std::string name = Create(Request(samples)).name();
    Watch(name);
    return FetchBytes(name);
  }
  std::string FetchBytes(const std::string& name) {
    TestContext context;
    v1::GetResultRequest request;
    request.set_name(name);
    const auto reader = server_->render().GetResult(&context, request);
    std::string bytes;
    for (v1::GetResultResponse chunk; reader->Read(&chunk);) bytes += chunk.data();
    const grpc::Status status = reader->Finish();
    EXPECT_TRUE(status.ok()) << status.error_message();
    return bytes;
  }
  std::vector<double> Irradiance(const std::string& bytes) {
    v1::RenderResult result;
    EXPECT_TRUE(result.ParseFromString(bytes));
    if (result.probes().empty()) return {};
    const auto& values = result.probes(0).irradiance();
    return {values.begin(), values.end()};
  }

  bool HasScene(const std::string& sha256) {
    TestContext context;
    v1::GetSceneRequest request;
    request.set_name("scenes/" + sha256);
    v1::GetSceneResponse response;
    return server_->scenes().GetScene(&context, request, &response).ok();
  }

  testing::TemporaryFolder folder_;
  std::unique_ptr<LoopbackServer> server_;
};

TEST_F(DurableTest, AnEndedJobIsTheSameAfterARestart) {
  Restart(Options());
  v1::CreateJobRequest request = Request(64);
  request.set_request_id("once");
  const std::string name = Create(request).name();
  Watch(name);
  const Watched before = Watch(name);  // In one go.
  const v1::Job job = Get(name);
  const std::string result = FetchBytes(name);
  EXPECT_EQ(job.state(), v1::Job::SUCCEEDED);
  Restart(Options());
  EXPECT_EQ(Get(name).SerializeAsString(), job.SerializeAsString());
  EXPECT_TRUE(FetchBytes(name) == result);
  const Watched after = Watch(name);
  EXPECT_EQ(after.job.SerializeAsString(), job.SerializeAsString());
  EXPECT_EQ(after.probe.irradiance_size(), 40);
  EXPECT_TRUE(after.probe.SerializeAsString() == before.probe.SerializeAsString());
  EXPECT_EQ(Create(request).name(), name);
}

TEST_F(DurableTest, AFailedJobKeepsItsError) {
  ServerOptions options = Options();
  options.start_rendering = [](std::shared_ptr<const Scene>, const Plan&) -> std::unique_ptr<Rendering> {
    throw std::runtime_error("the reason");
  };
  Restart(options);
  const std::string name = Create(Request(64)).name();
  Watch(name);
  const v1::Job job = Get(name);
  EXPECT_EQ(job.state(), v1::Job::FAILED);
  EXPECT_EQ(job.error().message(), "the reason");
  Restart(Options());
  EXPECT_EQ(Get(name).SerializeAsString(), job.SerializeAsString());
  EXPECT_EQ(Watch(name).job.state(), v1::Job::FAILED);
}

TEST_F(DurableTest, AJobGoesOnFromWhereItWas) {
  constexpr std::uint32_t kSamples = 40'000;
  const std::string whole = RenderWithoutAFolder(kSamples);
  Restart(Options());
  const std::string name = Create(Request(kSamples)).name();
  double fraction = 0;
  for (int i = 0; i < 1000 && fraction < 0.2; ++i) {
    fraction = Get(name).progress().fraction();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const v1::Job before = Get(name);
  ASSERT_EQ(before.state(), v1::Job::RUNNING);
  Restart(Options());
  // It was written down when the server before ended, and does not begin at nothing.
  double least = 1;
  for (int i = 0; i < 10'000 && least == 1; ++i) {
    const v1::Job job = Get(name);
    if (job.progress().samples() > 0) least = job.progress().fraction();
  }
  EXPECT_GE(least, before.progress().fraction());
  EXPECT_EQ(Watch(name).job.state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(Irradiance(FetchBytes(name)), Irradiance(whole));
  EXPECT_EQ(Get(name).start_time().seconds(), before.start_time().seconds());
}

TEST_F(DurableTest, APausedJobRestsAcrossRestartsAndGoesOnWithTheSameBits) {
  constexpr std::uint32_t kSamples = 20'000;
  const std::string whole = RenderWithoutAFolder(kSamples);
  ServerOptions options = Options();
  options.limits.max_running_jobs = 1;
  Restart(options);
  const std::string name = Create(Request(kSamples)).name();
  EXPECT_EQ(Control(&v1::RenderService::Stub::PauseJob, v1::PauseJobRequest(), name).state(), v1::Job::PAUSED);
  const std::string resumed = Create(Request(64)).name();
  Control(&v1::RenderService::Stub::PauseJob, v1::PauseJobRequest(), resumed);
  Control(&v1::RenderService::Stub::ResumeJob, v1::ResumeJobRequest(), resumed);
  for (int restarts = 0; restarts < 2; ++restarts) {
    Restart(options);
    EXPECT_EQ(Get(name).state(), v1::Job::PAUSED);
    // The only place is free for others.
    EXPECT_EQ(Watch(Create(Request(64)).name()).job.state(), v1::Job::SUCCEEDED);
    EXPECT_EQ(Watch(resumed).job.state(), v1::Job::SUCCEEDED);
  }
  EXPECT_NE(Control(&v1::RenderService::Stub::ResumeJob, v1::ResumeJobRequest(), name).state(), v1::Job::PAUSED);
  EXPECT_EQ(Watch(name).job.state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(Irradiance(FetchBytes(name)), Irradiance(whole));
}

TEST_F(DurableTest, APausedJobCanBeCancelledAfterARestart) {
  Restart(Options());
  const std::string name = Create(Request(1'000'000)).name();
  Control(&v1::RenderService::Stub::PauseJob, v1::PauseJobRequest(), name);
  Restart(Options());
  EXPECT_EQ(Control(&v1::RenderService::Stub::CancelJob, v1::CancelJobRequest(), name).state(), v1::Job::CANCELLED);
  Restart(Options());
  EXPECT_EQ(Get(name).state(), v1::Job::CANCELLED);
}

TEST_F(DurableTest, QueuedJobsCanBeCancelledAndWatchedBeforeTheirTurnComesAgain) {
  testing::FakeRenderings renderings(4);
  renderings.Hold();
  ServerOptions options = Options();
  options.limits.max_running_jobs = 1;
  options.start_rendering = [&](std::shared_ptr<const Scene> scene, const Plan& plan) {
    return renderings.Start(scene, plan);
  };
  Restart(options);
  std::vector<std::string> names;
  for (int i = 0; i < 3; ++i) names.push_back(Create(Request(64)).name());
  std::thread release([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    renderings.Release();  // A slice under way is waited for.
  });
  server_.reset();
  release.join();
  renderings.Hold();
  Restart(options);
  for (const std::string& name : names) EXPECT_NE(Get(name).state(), v1::Job::SUCCEEDED);
  TestContext context;
  v1::CancelJobRequest cancel;
  cancel.set_name(names[2]);
  v1::Job cancelled;
  EXPECT_TRUE(server_->render().CancelJob(&context, cancel, &cancelled).ok());
  EXPECT_EQ(cancelled.state(), v1::Job::CANCELLED);
  Watched watched;
  std::thread watcher([&] { watched = Watch(names[1]); });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  renderings.Release();
  watcher.join();
  EXPECT_EQ(watched.job.state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(watched.probe.positions_size(), 80);  // Of a watcher that came before the scene was read.
  EXPECT_EQ(watched.probe.irradiance_size(), 40);
}

TEST_F(DurableTest, AnUploadedSceneIsKeptForTheJobsThatNameIt) {
  Restart(Options());
  const std::string json = R"({"name":"mine","plane":{"materials":[{"name":"white","lambertian":{"reflectance":[0.5]}}],
      "curves":[{"name":"floor","segment":{"a":{"x":-1,"y":0},"b":{"x":1,"y":0}},"material":"white"},
                {"name":"lamp","segment":{"a":{"x":1,"y":1},"b":{"x":-1,"y":1}},"material":"white",
                 "emission":{"radiance":[1]}}]},"probes":[{"name":"floor","curve":"floor","count":40}]})";
  const std::string sha256 = Sha256Of(json);
  {
    TestContext context;
    v1::UploadSceneResponse response;
    const auto writer = server_->scenes().UploadScene(
        &context,
        [&] {
          v1::UploadSceneRequest upload;
          upload.set_sha256(sha256);
          upload.set_total_bytes(json.size());
          upload.set_data(json);
          return upload;
        }(),
        &response);
    ASSERT_TRUE(writer.ok()) << writer.error_message();
  }
  v1::CreateJobRequest request = Request(100'000);
  request.mutable_scene()->set_name("scenes/" + sha256);
  EXPECT_TRUE(HasScene(sha256));
  Restart(Options());
  EXPECT_TRUE(HasScene(sha256));
  const std::string name = Create(request).name();
  {
    TestContext context;
    v1::DeleteSceneRequest remove;
    remove.set_name("scenes/" + sha256);
    v1::DeleteSceneResponse removed;
    ASSERT_TRUE(server_->scenes().DeleteScene(&context, remove, &removed).ok());
  }
  Restart(Options());
  const Watched watched = Watch(name);
  EXPECT_FALSE(HasScene(sha256));
  EXPECT_EQ(watched.job.state(), v1::Job::SUCCEEDED) << watched.job.error().message();
  EXPECT_EQ(Get(name).scene(), "mine");
}

TEST_F(DurableTest, AFullDiskRefusesJobsAndLosesNone) {
  std::signal(SIGXFSZ, SIG_IGN);
  Restart(Options());
  const std::string running = Create(Request(20'000)).name();
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit full{4096, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &full);
  TestContext context;
  v1::Job job;
  const grpc::Status refused = server_->render().CreateJob(&context, Request(64), &job);
  Watch(running);
  const std::string result = FetchBytes(running);
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(refused.error_code(), StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(testing::ReasonOf(refused), "STORAGE_FULL");
  EXPECT_THAT(refused.error_message(), HasSubstr(folder_.path()));
  EXPECT_EQ(Irradiance(result).size(), 40u);
  Restart(Options());  // It is written at last.
  EXPECT_EQ(Get(running).state(), v1::Job::SUCCEEDED);
  EXPECT_TRUE(FetchBytes(running) == result);
}

TEST_F(DurableTest, WhoFollowsACancelledJobIsNotCancelledWithIt) {
  Restart(Options());
  const v1::CreateJobRequest endless = Request(1'000'000'000);
  const std::string leader = Create(endless).name();
  const std::string follower = Create(endless).name();
  while (!Get(follower).shared_work()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  TestContext context;
  v1::CancelJobRequest request;
  request.set_name(leader);
  v1::Job job;
  ASSERT_TRUE(server_->render().CancelJob(&context, request, &job).ok());
  EXPECT_EQ(job.state(), v1::Job::CANCELLED);
  Restart(Options());
  EXPECT_THAT(Get(follower).state(), AnyOf(v1::Job::QUEUED, v1::Job::RUNNING));
}

TEST_F(DurableTest, ADeletedJobStaysDeleted) {
  Restart(Options());
  const std::string name = Create(Request(64)).name();
  Watch(name);
  TestContext context;
  v1::DeleteJobRequest request;
  request.set_name(name);
  v1::DeleteJobResponse response;
  EXPECT_TRUE(server_->render().DeleteJob(&context, request, &response).ok());
  Restart(Options());
  TestContext again;
  v1::GetJobRequest get;
  get.set_name(name);
  v1::Job job;
  EXPECT_EQ(server_->render().GetJob(&again, get, &job).error_code(), StatusCode::NOT_FOUND);
}

}  // namespace
}  // namespace flatlight
