// SPDX-License-Identifier: Apache-2.0
// Watching a job on a server that breaks its streams.
#include "client/cli/jobs/watch.h"

#include <gmock/gmock.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "client/cli/jobs/comeback.h"
#include "client/cli/jobs/job_calls.h"
#include "client/cli/jobs/job_name.h"

namespace flatlight {
namespace {

using grpc::ServerContext;
using grpc::Status;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Each watch is answered by the next of `scripts`.
class Scripted : public v1::RenderService::Service, public v1::ServerService::Service {
 public:
  using Writer = grpc::ServerWriter<v1::WatchJobResponse>;
  using Script = std::function<Status(ServerContext*, Writer*)>;

  Status GetCapabilities(ServerContext*, const v1::GetCapabilitiesRequest*, v1::GetCapabilitiesResponse*) override {
    return Status::OK;
  }
  Status WatchJob(ServerContext* context, const v1::WatchJobRequest* request, Writer* writer) override {
    const std::lock_guard lock(mutex_);
    cursors_.emplace_back(request->epoch(), request->sequence());
    const std::size_t script = std::min(cursors_.size(), scripts_.size()) - 1;
    return scripts_[script](context, writer);
  }
  Status GetResult(ServerContext*, const v1::GetResultRequest*,
                   grpc::ServerWriter<v1::GetResultResponse>* writer) override {
    v1::GetResultResponse chunk;
    chunk.set_total_bytes(100);
    chunk.set_data("cut short");
    writer->Write(chunk);
    return Status::OK;
  }

  std::vector<Script> scripts_;
  std::mutex mutex_;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> cursors_;
};

v1::WatchJobResponse Update(std::uint64_t sequence, v1::Job::State state, double fraction) {
  v1::WatchJobResponse update;
  update.set_epoch(5);
  update.set_sequence(sequence);
  update.mutable_job()->set_name("jobs/x");
  update.mutable_job()->set_state(state);
  update.mutable_job()->mutable_progress()->set_fraction(fraction);
  return update;
}

const Status kGone(grpc::StatusCode::UNAVAILABLE, "going down");

class WatchTest : public ::testing::Test {
 protected:
  void SetUp() override {
    grpc::ServerBuilder builder;
    int port = 0;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
    builder.RegisterService(static_cast<v1::RenderService::Service*>(&service_));
    builder.RegisterService(static_cast<v1::ServerService::Service*>(&service_));
    server_ = builder.BuildAndStart();
    const auto address = ParseServerAddress("127.0.0.1:" + std::to_string(port), "test");
    auto connection = Connection::Open(*address, Tls(), "", interruption_);
    ASSERT_TRUE(connection.ok()) << connection.status();
    connection_ = *std::move(connection);
    options_.on_update = [this](const v1::Job& job) {
      updates_.push_back(job);
      return absl::OkStatus();
    };
  }

  Interruption interruption_;  // Before the server's threads, which would take its signals.
  Scripted service_;
  std::unique_ptr<grpc::Server> server_;
  std::unique_ptr<Connection> connection_;
  WatchOptions options_;
  std::vector<v1::Job> updates_;
};

TEST_F(WatchTest, ABrokenStreamIsTakenUpWhereItEnded) {
  service_.scripts_ = {[](ServerContext*, Scripted::Writer* writer) {
                         v1::WatchJobResponse first = Update(3, v1::Job::RUNNING, 0.25);
                         first.mutable_job()->set_scene("penumbra");
                         first.mutable_job()->mutable_plan()->set_summary("plan");
                         writer->Write(first);
                         v1::WatchJobResponse half = Update(4, v1::Job::RUNNING, 0.5);
                         half.set_more(true);  // Not all of sequence 4 is there yet.
                         writer->Write(half);
                         return kGone;
                       },
                       [](ServerContext*, Scripted::Writer*) { return Status::OK; },  // Too early.
                       [](ServerContext*, Scripted::Writer* writer) {
                         writer->Write(Update(9, v1::Job::SUCCEEDED, 1));
                         return Status::OK;
                       }};
  const auto job = WatchJob(*connection_, "jobs/x", options_);
  ASSERT_TRUE(job.ok()) << job.status();
  EXPECT_EQ(job->state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(job->scene(), "penumbra");  // Sent once.
  EXPECT_EQ(job->plan().summary(), "plan");
  EXPECT_EQ(updates_.size(), 3U);
  EXPECT_THAT(service_.cursors_, ElementsAre(std::pair(0, 0), std::pair(5, 3), std::pair(5, 3)));
}

// Adds records [first, first + count) of a log in which the irradiance of each is its index.
void AddRecords(std::uint32_t first, std::uint32_t count, v1::WatchJobResponse& update) {
  v1::RecordUpdate& records = *update.add_records();
  records.set_first(first);
  for (std::uint32_t i = first; i < first + count; ++i) records.add_records()->add_irradiance(i);
}

TEST_F(WatchTest, RecordsOfAStateThatBreaksOffAreToldOnce) {
  service_.scripts_ = {[](ServerContext*, Scripted::Writer* writer) {
                         v1::WatchJobResponse half = Update(3, v1::Job::SUCCEEDED, 1);
                         half.set_more(true);
                         AddRecords(0, 2, half);
                         writer->Write(half);
                         return kGone;
                       },
                       [](ServerContext*, Scripted::Writer* writer) {
                         v1::WatchJobResponse half = Update(3, v1::Job::SUCCEEDED, 1);
                         half.set_more(true);
                         AddRecords(0, 3, half);
                         writer->Write(half);
                         v1::WatchJobResponse rest = Update(3, v1::Job::SUCCEEDED, 1);
                         rest.clear_job();
                         AddRecords(3, 2, rest);
                         writer->Write(rest);
                         return Status::OK;
                       }};
  std::vector<double> records;
  options_.on_record = [&](std::uint32_t index, const v1::CacheRecord& record) {
    EXPECT_EQ(index, records.size());
    records.push_back(record.irradiance(0));
    return absl::OkStatus();
  };
  ASSERT_TRUE(WatchJob(*connection_, "jobs/x", options_).ok());
  EXPECT_THAT(records, ElementsAre(0, 1, 2, 3, 4));
}

TEST_F(WatchTest, ASilentStreamIsLeft) {
  options_.silence = std::chrono::milliseconds(50);
  service_.scripts_ = {[](ServerContext* context, Scripted::Writer* writer) {
                         v1::WatchJobResponse heartbeat;
                         heartbeat.set_epoch(5);
                         heartbeat.set_sequence(1);
                         while (!context->IsCancelled()) std::this_thread::yield();
                         writer->Write(heartbeat);
                         return Status::CANCELLED;
                       },
                       [](ServerContext*, Scripted::Writer* writer) {
                         writer->Write(Update(2, v1::Job::CANCELLED, 0.5));
                         return Status::OK;
                       }};
  const auto job = WatchJob(*connection_, "jobs/x", options_);
  ASSERT_TRUE(job.ok()) << job.status();
  EXPECT_EQ(CheckSuccess(*job).code(), absl::StatusCode::kInternal);
}

TEST_F(WatchTest, PatienceEnds) {
  options_.patience = std::chrono::milliseconds(100);
  service_.scripts_ = {[](ServerContext*, Scripted::Writer*) { return kGone; }};
  const auto job = WatchJob(*connection_, "jobs/x", options_);
  EXPECT_EQ(job.status().code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(job.status().ToString(), HasSubstr("going down"));
  EXPECT_GT(service_.cursors_.size(), 1U);
}

TEST_F(WatchTest, ErrorsThatStayAreNotRepeated) {
  service_.scripts_ = {
      [](ServerContext*, Scripted::Writer*) { return Status(grpc::StatusCode::NOT_FOUND, "no such job"); }};
  EXPECT_EQ(WatchJob(*connection_, "jobs/x", options_).status().code(), absl::StatusCode::kNotFound);
  EXPECT_EQ(service_.cursors_.size(), 1U);
}

TEST_F(WatchTest, ASignalEndsTheWatch) {
  service_.scripts_ = {[](ServerContext* context, Scripted::Writer* writer) {
    writer->Write(Update(1, v1::Job::RUNNING, 0));
    while (!context->IsCancelled()) std::this_thread::yield();
    return Status::CANCELLED;
  }};
  options_.on_update = [](const v1::Job&) {
    kill(getpid(), SIGINT);
    return absl::OkStatus();
  };
  EXPECT_EQ(WatchJob(*connection_, "jobs/x", options_).status().code(), absl::StatusCode::kCancelled);
  EXPECT_TRUE(interruption_.Requested());
}

TEST_F(WatchTest, AnUnwantedUpdateEndsTheWatch) {
  service_.scripts_ = {[](ServerContext* context, Scripted::Writer* writer) {
    writer->Write(Update(1, v1::Job::RUNNING, 0));
    while (!context->IsCancelled()) std::this_thread::yield();
    return Status::CANCELLED;
  }};
  options_.on_update = [](const v1::Job&) { return absl::DataLossError("nobody reads"); };
  EXPECT_EQ(WatchJob(*connection_, "jobs/x", options_).status(), absl::DataLossError("nobody reads"));
  EXPECT_EQ(service_.cursors_.size(), 1U);
}

TEST_F(WatchTest, AResultThatIsCutShortIsNoResult) {
  EXPECT_EQ(FetchResult(*connection_, "jobs/x").status().code(), absl::StatusCode::kInternal);
}

TEST(JobName, NamesUuidsAndBeginnings) {
  const std::string a = "jobs/12345678-1234-4234-8234-123456789abc", b = "jobs/12aaaaaa-1234-4234-8234-123456789abc";
  EXPECT_EQ(*MatchJobName(a, {}), a);
  EXPECT_EQ(*MatchJobName(a.substr(5), {}), a);
  EXPECT_EQ(*MatchJobName("123", {a, b}), a);
  EXPECT_EQ(*MatchJobName("jobs/12a", {a, b}), b);
  EXPECT_THAT(MatchJobName("12", {a, b}).status().ToString(), HasSubstr("2 jobs begin with '12'"));
  EXPECT_THAT(MatchJobName("9", {a, b}).status().ToString(), HasSubstr("no job begins with '9'"));
  for (const char* bad : {"", "jobs/", "xyz", "1234-", "12345678-1234-4234-8234-123456789abcd"})
    EXPECT_FALSE(MatchJobName(bad, {a, b}).ok()) << bad;
  EXPECT_TRUE(IsWholeJobName("jobs/" + NewUuid()));
  EXPECT_NE(NewUuid(), NewUuid());
}

}  // namespace
}  // namespace flatlight
