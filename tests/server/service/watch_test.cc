// SPDX-License-Identifier: Apache-2.0
// WatchJob over a real connection.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <thread>

#include "tests/support/loopback/loopback_server.h"
#include "tests/support/rendering/fake_rendering.h"

namespace flatlight {
namespace {

using testing::DetailOf;
using testing::FakeRenderings;
using testing::FloorAndLampProto;
using testing::LoopbackServer;
using testing::ReasonOf;
using testing::TestContext;

constexpr int kSteps = 6;

class WatchTest : public ::testing::Test {
 protected:
  ~WatchTest() override { renderings_.Release(); }

  ServerOptions Options() {
    ServerOptions options;
    options.start_rendering = [this](std::shared_ptr<const Scene> scene, const Plan& plan) {
      return renderings_.Start(scene, plan);
    };
    return options;
  }

  static std::string Create(LoopbackServer& server, const std::vector<std::uint32_t>& counts) {
    v1::CreateJobRequest request;
    *request.mutable_scene()->mutable_scene() = FloorAndLampProto(counts);
    request.mutable_settings()->set_method(v1::Settings::PATH_TRACING);
    TestContext context;
    v1::Job job;
    const grpc::Status status = server.render().CreateJob(&context, request, &job);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return job.name();
  }

  FakeRenderings renderings_{kSteps};
};

// A reader of one watch.
class Watch {
 public:
  Watch(v1::RenderService::Stub& stub, const std::string& name, std::uint64_t epoch = 0, std::uint64_t sequence = 0,
        double max_rate = 1000) {
    v1::WatchJobRequest request;
    request.set_name(name);
    request.set_epoch(epoch);
    request.set_sequence(sequence);
    request.set_max_rate(max_rate);
    reader_ = stub.WatchJob(&context_, request);
  }
  bool Next(v1::WatchJobResponse& message) { return reader_->Read(&message); }
  v1::WatchJobResponse NextThat(const std::function<bool(const v1::WatchJobResponse&)>& condition) {
    v1::WatchJobResponse message;
    while (Next(message)) {
      if (condition(message)) return message;
    }
    ADD_FAILURE() << "the watch ended";
    return {};
  }
  std::vector<v1::WatchJobResponse> Rest() {
    std::vector<v1::WatchJobResponse> messages;
    v1::WatchJobResponse message;
    while (Next(message)) messages.push_back(message);
    return messages;
  }
  grpc::Status Finish() { return reader_->Finish(); }
  void Cancel() { context_.TryCancel(); }

 private:
  TestContext context_;
  std::unique_ptr<grpc::ClientReader<v1::WatchJobResponse>> reader_;
};

bool HasValues(const v1::WatchJobResponse& message) {
  return message.updates_size() > 0 && message.updates(0).points().irradiance_size() > 0;
}

// What a client makes of messages: the newest value of each point, by probe.
std::map<std::uint32_t, std::map<std::uint32_t, double>> Assemble(const std::vector<v1::WatchJobResponse>& messages) {
  std::map<std::uint32_t, std::map<std::uint32_t, double>> values;
  for (const auto& message : messages) {
    for (const auto& update : message.updates()) {
      for (int i = 0; i < update.points().irradiance_size(); ++i) {
        values[update.probe()][update.first() + static_cast<std::uint32_t>(i)] = update.points().irradiance(i);
      }
    }
  }
  return values;
}

TEST_F(WatchTest, FollowsAJobToItsEnd) {
  LoopbackServer server(Options());
  renderings_.Hold();
  Watch watch(server.render(), Create(server, {10, 3}));
  v1::WatchJobResponse first;
  ASSERT_TRUE(watch.Next(first));
  EXPECT_NE(first.epoch(), 0u);
  EXPECT_TRUE(first.job().has_plan());
  ASSERT_EQ(first.updates_size(), 2);
  EXPECT_EQ(first.updates(0).points().name(), "probe0");
  EXPECT_EQ(first.updates(0).points().positions_size(), 20);
  renderings_.Release();
  const auto rest = watch.Rest();
  EXPECT_TRUE(watch.Finish().ok());
  ASSERT_FALSE(rest.empty());
  EXPECT_EQ(rest.back().job().state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(rest.back().job().end_reason(), v1::SAMPLES_DONE);
  std::uint64_t sequence = first.sequence();
  for (const auto& message : rest) {
    EXPECT_GT(message.sequence(), sequence);
    sequence = message.sequence();
    EXPECT_FALSE(message.job().has_plan()) << "the plan never changes";
    for (const auto& update : message.updates()) EXPECT_EQ(update.points().positions_size(), 0);
  }
  const auto values = Assemble(rest);
  for (const auto& [i, value] : values.at(0)) EXPECT_EQ(value, kSteps);
  EXPECT_EQ(values.at(0).size(), 10u);
  EXPECT_EQ(values.at(1).size(), 3u);
}

TEST_F(WatchTest, ALateJoinerGetsEverythingAtOnce) {
  LoopbackServer server(Options());
  const std::string name = Create(server, {10});
  Watch(server.render(), name).Rest();
  Watch late(server.render(), name);
  const auto messages = late.Rest();
  EXPECT_TRUE(late.Finish().ok());
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0].job().state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(messages[0].updates(0).points().irradiance(9), kSteps);
  EXPECT_EQ(messages[0].updates(0).points().positions_size(), 20);
}

TEST_F(WatchTest, AResumedWatchGetsOnlyWhatIsNewer) {
  LoopbackServer server(Options());
  renderings_.Hold();
  const std::string name = Create(server, {10, 3});
  renderings_.Allow(1);
  Watch first(server.render(), name);
  const v1::WatchJobResponse seen = first.NextThat(HasValues);
  first.Cancel();
  renderings_.Release();
  Watch resumed(server.render(), name, seen.epoch(), seen.sequence());
  const auto messages = resumed.Rest();
  ASSERT_FALSE(messages.empty());
  for (const auto& message : messages) {
    // At once a heartbeat, if nothing is newer yet.
    if (message.has_job()) {
      EXPECT_GT(message.sequence(), seen.sequence());
    }
    // The second probe has not changed since the first step.
    for (const auto& update : message.updates()) {
      EXPECT_EQ(update.probe(), 0u);
      EXPECT_EQ(update.points().positions_size(), 0);
    }
  }
  EXPECT_EQ(messages.back().updates(0).points().irradiance(0), kSteps);
  // At the newest state already, there is nothing to send.
  Watch done(server.render(), name, seen.epoch(), messages.back().sequence());
  EXPECT_TRUE(done.Rest().empty());
  EXPECT_TRUE(done.Finish().ok());
}

TEST_F(WatchTest, AResumedWatchWithoutNewsLearnsThatItIsConnected) {
  LoopbackServer server(Options());
  renderings_.Hold();
  const std::string name = Create(server, {10});
  renderings_.Allow(1);
  Watch first(server.render(), name);
  const v1::WatchJobResponse seen = first.NextThat(HasValues);
  Watch resumed(server.render(), name, seen.epoch(), seen.sequence());
  v1::WatchJobResponse heartbeat;
  ASSERT_TRUE(resumed.Next(heartbeat));
  EXPECT_EQ(heartbeat.sequence(), seen.sequence());
  EXPECT_FALSE(heartbeat.has_job());
  first.Cancel();
  resumed.Cancel();
}

TEST_F(WatchTest, AForeignEpochStartsAgain) {
  LoopbackServer server(Options());
  const std::string name = Create(server, {10});
  const auto messages = Watch(server.render(), name).Rest();
  Watch foreign(server.render(), name, messages[0].epoch() + 2, messages.back().sequence() + 100);
  const auto again = foreign.Rest();
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0].epoch(), messages[0].epoch());
  EXPECT_EQ(again[0].updates(0).points().positions_size(), 20);
}

TEST_F(WatchTest, ASequenceFromTheFutureIsAnError) {
  LoopbackServer server(Options());
  const std::string name = Create(server, {10});
  const auto messages = Watch(server.render(), name).Rest();
  Watch ahead(server.render(), name, messages[0].epoch(), messages.back().sequence() + 1);
  EXPECT_TRUE(ahead.Rest().empty());
  const grpc::Status status = ahead.Finish();
  EXPECT_EQ(status.error_code(), grpc::StatusCode::OUT_OF_RANGE);
  EXPECT_EQ(ReasonOf(status), "SEQUENCE_AHEAD");
}

TEST_F(WatchTest, BigStatesComeInSeveralMessages) {
  LoopbackServer server(Options());
  const std::string name = Create(server, {50'000, 7});
  Watch(server.render(), name).Rest();
  const auto messages = Watch(server.render(), name).Rest();
  ASSERT_GT(messages.size(), 4u);
  for (std::size_t i = 0; i < messages.size(); ++i) {
    EXPECT_EQ(messages[i].more(), i + 1 < messages.size());
    EXPECT_EQ(messages[i].sequence(), messages[0].sequence());
    EXPECT_LE(messages[i].ByteSizeLong(), 512u << 10);
  }
  const auto values = Assemble(messages);
  EXPECT_EQ(values.at(0).size(), 50'000u);
  EXPECT_EQ(values.at(1).size(), 7u);
}

// What a client makes of messages: the log, by index. Each record may come once alone.
std::vector<v1::CacheRecord> AssembleRecords(const std::vector<v1::WatchJobResponse>& messages,
                                             std::vector<v1::CacheRecord> log = {}) {
  for (const auto& message : messages) {
    for (const v1::RecordUpdate& update : message.records()) {
      if (update.records_size() > 0) {
        EXPECT_EQ(update.first(), log.size());
        log.insert(log.end(), update.records().begin(), update.records().end());
      }
      for (int i = 0; i < update.radius_size(); i += 2) {
        v1::CacheRecord& record = log.at(update.first() + static_cast<std::size_t>(i) / 2);
        record.clear_radius();
        record.add_radius(update.radius(i)), record.add_radius(update.radius(i + 1));
      }
    }
  }
  return log;
}

v1::RenderResult Result(LoopbackServer& server, const std::string& name) {
  v1::GetResultRequest request;
  request.set_name(name);
  TestContext context;
  const auto reader = server.render().GetResult(&context, request);
  v1::GetResultResponse chunk;
  std::string bytes;
  while (reader->Read(&chunk)) bytes += chunk.data();
  EXPECT_TRUE(reader->Finish().ok());
  v1::RenderResult result;
  EXPECT_TRUE(result.ParseFromString(bytes));
  return result;
}

void ExpectEqualLogs(const std::vector<v1::CacheRecord>& log, const v1::RenderResult& result) {
  ASSERT_EQ(log.size(), static_cast<std::size_t>(result.records_size()));
  for (std::size_t i = 0; i < log.size(); ++i)
    EXPECT_EQ(log[i].SerializeAsString(), result.records(static_cast<int>(i)).SerializeAsString()) << i;
}

TEST_F(WatchTest, TheLogOfRecordsIsThatOfTheResultForEveryWatcher) {
  renderings_.set_records_per_step(3);
  LoopbackServer server(Options());
  renderings_.Hold();
  const std::string name = Create(server, {10});
  Watch all(server.render(), name), leaver(server.render(), name);
  renderings_.Allow(1);
  std::vector<v1::WatchJobResponse> seen;
  v1::WatchJobResponse message;
  while (AssembleRecords(seen).empty() && leaver.Next(message)) seen.push_back(message);
  leaver.Cancel();
  const std::vector<v1::CacheRecord> known = AssembleRecords(seen);
  renderings_.Allow(2);
  Watch late(server.render(), name);
  v1::WatchJobResponse early;
  ASSERT_TRUE(late.Next(early));
  renderings_.Release();
  Watch resumed(server.render(), name, seen.back().epoch(), seen.back().sequence());
  const auto resumed_messages = resumed.Rest();
  std::vector<v1::WatchJobResponse> late_messages = late.Rest();
  late_messages.insert(late_messages.begin(), early);
  const v1::RenderResult result = Result(server, name);
  ASSERT_EQ(result.records_size(), 3 * kSteps);
  ExpectEqualLogs(AssembleRecords(all.Rest()), result);
  ExpectEqualLogs(AssembleRecords(late_messages), result);
  ExpectEqualLogs(AssembleRecords(resumed_messages, known), result);
  for (const auto& update : resumed_messages) {
    for (const v1::RecordUpdate& records : update.records()) {
      if (records.first() < known.size()) {
        EXPECT_EQ(records.records_size(), 0) << "sent twice";
      }
    }
  }
  ExpectEqualLogs(AssembleRecords(Watch(server.render(), name).Rest()), result);
}

TEST_F(WatchTest, ALongLogComesInSeveralMessages) {
  renderings_.set_records_per_step(5000);
  LoopbackServer server(Options());
  const std::string name = Create(server, {10});
  Watch(server.render(), name).Rest();
  const auto messages = Watch(server.render(), name).Rest();
  ASSERT_GT(messages.size(), 2u);
  for (std::size_t i = 0; i < messages.size(); ++i) {
    EXPECT_EQ(messages[i].more(), i + 1 < messages.size());
    EXPECT_LE(messages[i].ByteSizeLong(), 512u << 10);
  }
  ExpectEqualLogs(AssembleRecords(messages), Result(server, name));
}

TEST_F(WatchTest, ASlowReaderGetsFewerAndNewerMessages) {
  FakeRenderings endless(1'000'000);
  ServerOptions options;
  options.start_rendering = [&](std::shared_ptr<const Scene> scene, const Plan& plan) {
    return endless.Start(scene, plan);
  };
  LoopbackServer server(options);
  const std::string name = Create(server, {200'000});  // 5 MB a state, far more than the connection buffers.
  const auto slow_channel = server.NewChannel();
  const auto slow_stub = v1::RenderService::NewStub(slow_channel);
  Watch slow(*slow_stub, name);
  const v1::WatchJobResponse first = slow.NextThat(HasValues);
  // The reader rests while the job goes through 20 states.
  Watch quick(server.render(), name, first.epoch(), first.sequence());
  const v1::WatchJobResponse newest =
      quick.NextThat([&](const auto& message) { return message.sequence() >= first.sequence() + 20; });
  quick.Cancel();
  // What it reads next ends the state it had begun, and then is no older than when it rested.
  std::uint64_t states_between = 0;
  std::uint64_t last = first.sequence();
  slow.NextThat([&](const auto& message) {
    if (message.sequence() > last) {
      ++states_between;
      last = message.sequence();
    }
    return message.sequence() >= newest.sequence();
  });
  // A queue would bring all 20; the connection's buffers may have taken in a few before they were full.
  EXPECT_LE(states_between, 10u) << "states that nobody waits for any more were kept for it";
  slow.Cancel();
}

TEST_F(WatchTest, KeepsToTheRate) {
  FakeRenderings endless(1'000'000);
  ServerOptions options;
  options.start_rendering = [&](std::shared_ptr<const Scene> scene, const Plan& plan) {
    return endless.Start(scene, plan);
  };
  LoopbackServer server(options);
  const std::string name = Create(server, {4});
  const auto start = std::chrono::steady_clock::now();
  Watch watch(server.render(), name, 0, 0, /*max_rate=*/5);
  watch.NextThat(HasValues);
  watch.NextThat(HasValues);
  const v1::WatchJobResponse third = watch.NextThat(HasValues);
  // Two intervals of 0.2 s lie between the first and the third.
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(400));
  EXPECT_EQ(third.job().state(), v1::Job::RUNNING);
  watch.Cancel();
}

TEST_F(WatchTest, AHeartbeatComesWhenNothingHappens) {
  ServerOptions options = Options();
  options.heartbeat = std::chrono::milliseconds(20);
  LoopbackServer server(options);
  renderings_.Hold();
  Watch watch(server.render(), Create(server, {4}));
  const v1::WatchJobResponse running =
      watch.NextThat([](const auto& message) { return message.job().state() == v1::Job::RUNNING; });
  for (int i = 0; i < 3; ++i) {
    v1::WatchJobResponse heartbeat;
    ASSERT_TRUE(watch.Next(heartbeat));
    EXPECT_EQ(heartbeat.epoch(), running.epoch());
    EXPECT_EQ(heartbeat.sequence(), running.sequence());
    EXPECT_FALSE(heartbeat.has_job());
    EXPECT_EQ(heartbeat.updates_size(), 0);
  }
  watch.Cancel();
}

TEST_F(WatchTest, CancellingAJobEndsItsWatch) {
  LoopbackServer server(Options());
  renderings_.Hold();
  const std::string name = Create(server, {4});
  Watch watch(server.render(), name);
  v1::CancelJobRequest request;
  request.set_name(name);
  TestContext context;
  v1::Job job;
  ASSERT_TRUE(server.render().CancelJob(&context, request, &job).ok());
  EXPECT_EQ(job.state(), v1::Job::CANCELLED);
  const auto messages = watch.Rest();
  EXPECT_EQ(messages.back().job().state(), v1::Job::CANCELLED);
  EXPECT_TRUE(watch.Finish().ok());
}

TEST_F(WatchTest, DeletingAJobEndsItsWatch) {
  LoopbackServer server(Options());
  renderings_.Hold();
  const std::string name = Create(server, {4});
  Watch watch(server.render(), name);
  v1::WatchJobResponse first;
  ASSERT_TRUE(watch.Next(first));
  v1::DeleteJobRequest request;
  request.set_name(name);
  TestContext context;
  v1::DeleteJobResponse response;
  ASSERT_TRUE(server.render().DeleteJob(&context, request, &response).ok());
  watch.Rest();
  const grpc::Status status = watch.Finish();
  EXPECT_EQ(status.error_code(), grpc::StatusCode::NOT_FOUND);
  EXPECT_EQ(ReasonOf(status), "JOB_NOT_FOUND");
}

TEST_F(WatchTest, OneWatchTooManyIsRefused) {
  ServerOptions options = Options();
  options.limits.max_watches = 1;
  LoopbackServer server(options);
  renderings_.Hold();
  const std::string name = Create(server, {4});
  Watch first(server.render(), name);
  v1::WatchJobResponse message;
  ASSERT_TRUE(first.Next(message));
  Watch second(server.render(), name);
  EXPECT_TRUE(second.Rest().empty());
  const grpc::Status status = second.Finish();
  EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(ReasonOf(status), "TOO_MANY_WATCHES");
  const auto quota = DetailOf<google::rpc::QuotaFailure>(status);
  ASSERT_TRUE(quota);
  EXPECT_EQ(quota->violations(0).subject(), "max_watches");
  ASSERT_TRUE(DetailOf<google::rpc::RetryInfo>(status));
  first.Cancel();
}

TEST_F(WatchTest, DrainingTellsEveryWatcher) {
  LoopbackServer server(Options());
  renderings_.Hold();
  const std::string name = Create(server, {4});
  Watch watch(server.render(), name);
  const v1::WatchJobResponse running =
      watch.NextThat([](const auto& message) { return message.job().state() == v1::Job::RUNNING; });
  std::thread drain([&] { server.server().Drain(std::chrono::seconds(20)); });
  const auto messages = watch.Rest();
  const grpc::Status status = watch.Finish();
  drain.join();
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_TRUE(messages[0].draining());
  EXPECT_EQ(messages[0].sequence(), running.sequence());
  EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(ReasonOf(status), "DRAINING");
}

}  // namespace
}  // namespace flatlight
