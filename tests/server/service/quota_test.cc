// SPDX-License-Identifier: Apache-2.0
// What each of a class may have, at its borders, over real connections.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/store/sha256.h"
#include "tests/support/loopback/class_test.h"
#include "tests/support/loopback/loopback_server.h"
#include "tests/support/rendering/fake_clock.h"

namespace flatlight {
namespace {

using grpc::StatusCode;
using std::chrono::hours;
using testing::DetailOf;
using ::testing::HasSubstr;
using testing::ReasonOf;
using testing::TestContext;

constexpr std::uint32_t kEndless = 1'000'000'000;  // Samples.
constexpr std::chrono::system_clock::time_point kLate{hours(24 * 20'000 + 23)};

class QuotaTest : public testing::ClassTest {
 protected:
  void StartWith(const std::vector<std::string>& quotas) {
    quotas_ = quotas;
    Restart();
    AddClass();
  }
  void Restart() {
    server_.reset();
    ServerOptions options;
    for (const std::string& quota : quotas_) ASSERT_TRUE(options.quotas.Set(quota).ok()) << quota;
    options.request_clock = &request_clock_;
    options.day_clock = [this] {
      const std::lock_guard lock(mutex_);
      return day_time_;
    };
    Start(options);
  }
  void SetTime(std::chrono::system_clock::time_point time) {
    const std::lock_guard lock(mutex_);
    day_time_ = time;
  }
  grpc::Status TryCreate(const std::string& user, std::uint32_t samples = kEndless) {
    v1::CreateJobRequest request;
    *request.mutable_scene()->mutable_scene() = testing::FloorAndLampProto({4});
    request.mutable_settings()->set_method(v1::Settings::PATH_TRACING);
    request.mutable_settings()->set_samples(samples);
    return Call(user, request, job_, &v1::RenderService::Stub::CreateJob);
  }
  v1::Quotas QuotasOf(const std::string& user) {
    TestContext context;
    Identify(user, context);
    v1::GetCapabilitiesResponse response;
    EXPECT_TRUE(server_->info().GetCapabilities(&context, v1::GetCapabilitiesRequest(), &response).ok());
    return response.quotas();
  }
  grpc::Status Upload(const std::string& user, const std::string& bytes) {
    TestContext context;
    Identify(user, context);
    v1::UploadSceneRequest request;
    request.set_sha256(Sha256Of(bytes));
    request.set_total_bytes(bytes.size());
    request.set_data(bytes);
    v1::UploadSceneResponse response;
    return server_->scenes().UploadScene(&context, request, &response);
  }
  grpc::Status DeleteScene(const std::string& user, const std::string& bytes) {
    TestContext context;
    Identify(user, context);
    v1::DeleteSceneRequest request;
    request.set_name("scenes/" + Sha256Of(bytes));
    v1::DeleteSceneResponse response;
    return server_->scenes().DeleteScene(&context, request, &response);
  }
  // All that a refusal says.
  static void ExpectRefused(const grpc::Status& status, const std::string& reason, const std::string& limit,
                            const std::string& used, const std::string& allowed) {
    EXPECT_EQ(status.error_code(), StatusCode::RESOURCE_EXHAUSTED) << status.error_message();
    const auto info = DetailOf<google::rpc::ErrorInfo>(status);
    const auto failure = DetailOf<google::rpc::QuotaFailure>(status);
    ASSERT_TRUE(info && failure && DetailOf<google::rpc::RetryInfo>(status)) << status.error_message();
    EXPECT_EQ(info->reason(), reason);
    EXPECT_EQ(info->metadata().at("used"), used);
    EXPECT_EQ(info->metadata().at("allowed"), allowed);
    EXPECT_EQ(failure->violations(0).subject(), limit);
    EXPECT_EQ(failure->violations(0).description(), status.error_message());
  }
  static double RetrySeconds(const grpc::Status& status) {
    const auto retry = DetailOf<google::rpc::RetryInfo>(status);
    return retry ? static_cast<double>(retry->retry_delay().seconds()) + 1e-9 * retry->retry_delay().nanos() : -1;
  }
  bool Counts(const std::string& reason) {
    const std::string line = "flatlight_refusals_total{reason=\"" + reason + "\"} ";
    return server_->server().MetricsText().find(line) != std::string::npos;
  }

  std::vector<std::string> quotas_;
  testing::FakeClock request_clock_;
  std::mutex mutex_;
  std::chrono::system_clock::time_point day_time_ = kLate;
  v1::Job job_;
};

TEST_F(QuotaTest, Jobs) {
  StartWith({"student.jobs=2", "grader.jobs=3"});
  ASSERT_TRUE(TryCreate("ada").ok());
  const std::string first = job_.name();
  ASSERT_TRUE(TryCreate("ada").ok());
  EXPECT_EQ(QuotasOf("ada").jobs().used(), 2);
  const grpc::Status refused = TryCreate("ada");
  ExpectRefused(refused, "TOO_MANY_JOBS", "max_jobs_per_user", "2", "2");
  EXPECT_THAT(refused.error_message(), HasSubstr("2 of your jobs have not ended; allowed: 2"));
  EXPECT_GT(RetrySeconds(refused), 0);
  EXPECT_TRUE(Counts("TOO_MANY_JOBS"));
  EXPECT_TRUE(TryCreate("bob").ok());
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(TryCreate("gus").ok());
  ExpectRefused(TryCreate("gus"), "TOO_MANY_JOBS", "max_jobs_per_user", "3", "3");
  ASSERT_TRUE(Cancel("ada", first).ok());
  EXPECT_TRUE(TryCreate("ada").ok());
  Restart();
  EXPECT_EQ(QuotasOf("ada").jobs().used(), 2);
  EXPECT_EQ(TryCreate("ada").error_code(), StatusCode::RESOURCE_EXHAUSTED) << "those of before count";
}

TEST_F(QuotaTest, ProcessorTimeOfADay) {
  StartWith({"student.cpu-seconds=0.02"});
  ASSERT_TRUE(TryCreate("ada").ok());
  const std::string job = job_.name();
  const auto awaits = [&](v1::QueuePlace::Reason reason) {
    v1::GetJobRequest request;
    request.set_name(job);
    do {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      if (!Call("ada", request, job_, &v1::RenderService::Stub::GetJob).ok()) return false;
    } while (job_.queue().reason() != reason);
    return true;
  };
  ASSERT_TRUE(awaits(v1::QueuePlace::DAY_USED_UP));
  EXPECT_EQ(job_.state(), v1::Job::QUEUED);
  EXPECT_EQ(job_.queue().expected_start().seconds(), 20'001 * 86'400);
  const v1::Quotas quotas = QuotasOf("ada");
  EXPECT_GE(quotas.cpu_seconds().used(), 0.02);
  EXPECT_EQ(quotas.cpu_seconds().limit(), 0.02);
  EXPECT_EQ(quotas.day_ends_in(), 3600);

  const grpc::Status refused = TryCreate("ada");
  EXPECT_EQ(ReasonOf(refused), "PROCESSOR_TIME_USED_UP");
  EXPECT_EQ(DetailOf<google::rpc::QuotaFailure>(refused)->violations(0).subject(), "max_cpu_seconds_per_day");
  EXPECT_EQ(DetailOf<google::rpc::ErrorInfo>(refused)->metadata().at("allowed"), "0.02");
  EXPECT_EQ(RetrySeconds(refused), 3600);
  EXPECT_TRUE(Counts("PROCESSOR_TIME_USED_UP"));
  EXPECT_TRUE(TryCreate("bob", 16).ok());
  EXPECT_TRUE(TryCreate("gus", 16).ok());

  const double used = QuotasOf("ada").cpu_seconds().used();
  Restart();
  EXPECT_NEAR(QuotasOf("ada").cpu_seconds().used(), used, 1e-6);
  EXPECT_EQ(ReasonOf(TryCreate("ada")), "PROCESSOR_TIME_USED_UP") << "it outlives the server";
  ASSERT_TRUE(awaits(v1::QueuePlace::DAY_USED_UP)) << "and so does the rest of its job";
  SetTime(kLate + hours(1));
  EXPECT_TRUE(TryCreate("ada").ok());
  EXPECT_LT(QuotasOf("ada").day_ends_in(), 24 * 3600 + 1);
  ASSERT_TRUE(awaits(v1::QueuePlace::REASON_UNSPECIFIED)) << "it goes on by itself";
  EXPECT_EQ(job_.state(), v1::Job::RUNNING);
}

TEST_F(QuotaTest, Watches) {
  StartWith({"student.watches=2"});
  ASSERT_TRUE(TryCreate("ada").ok());
  const std::string name = job_.name();
  struct Watching {
    TestContext context;
    std::unique_ptr<grpc::ClientReader<v1::WatchJobResponse>> stream;
  };
  const auto watch = [&](const std::string& user) {
    auto watching = std::make_unique<Watching>();
    Identify(user, watching->context);
    v1::WatchJobRequest request;
    request.set_name(name);
    watching->stream = server_->render().WatchJob(&watching->context, request);
    return watching;
  };
  v1::WatchJobResponse update;
  auto first = watch("ada");
  ASSERT_TRUE(first->stream->Read(&update));
  const auto second = watch("ada");
  ASSERT_TRUE(second->stream->Read(&update));
  EXPECT_EQ(QuotasOf("ada").watches().used(), 2);
  const auto third = watch("ada");
  EXPECT_FALSE(third->stream->Read(&update));
  const grpc::Status refused = third->stream->Finish();
  ExpectRefused(refused, "TOO_MANY_OWN_WATCHES", "max_watches_per_user", "2", "2");
  EXPECT_TRUE(Counts("TOO_MANY_OWN_WATCHES"));
  const auto others = watch("gus");
  EXPECT_TRUE(others->stream->Read(&update));
  first->context.TryCancel();
  while (first->stream->Read(&update)) continue;
  first->stream->Finish();
  while (QuotasOf("ada").watches().used() > 1) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  const auto again = watch("ada");
  EXPECT_TRUE(again->stream->Read(&update));
}

TEST_F(QuotaTest, Requests) {
  StartWith({"student.requests=2"});
  for (int i = 0; i < 20; ++i) ASSERT_EQ(ReasonOf(Get("ada", "jobs/x")), "BAD_REQUEST") << i;
  const grpc::Status refused = Get("ada", "jobs/x");
  ExpectRefused(refused, "TOO_MANY_REQUESTS", "max_requests_per_user", "20", "20");
  EXPECT_THAT(refused.error_message(), HasSubstr("allowed: 20, and 2 more a second"));
  EXPECT_EQ(RetrySeconds(refused), 0.5);
  EXPECT_EQ(ReasonOf(Watch("ada", "jobs/x")), "TOO_MANY_REQUESTS") << "streams count too";
  EXPECT_EQ(ReasonOf(Fetch("ada", "jobs/x")), "TOO_MANY_REQUESTS");
  EXPECT_EQ(ReasonOf(Get("bob", "jobs/x")), "BAD_REQUEST");
  EXPECT_TRUE(Counts("TOO_MANY_REQUESTS"));
  request_clock_.Advance(std::chrono::milliseconds(499));
  EXPECT_EQ(ReasonOf(Get("ada", "jobs/x")), "TOO_MANY_REQUESTS");
  request_clock_.Advance(std::chrono::milliseconds(1));
  EXPECT_EQ(ReasonOf(Get("ada", "jobs/x")), "BAD_REQUEST");
  EXPECT_EQ(ReasonOf(Get("ada", "jobs/x")), "TOO_MANY_REQUESTS");
}

TEST_F(QuotaTest, StorageOfScenes) {
  StartWith({"student.storage-mib=1"});
  const std::string half(512u << 10, 'a');
  const std::string other_half(512u << 10, 'b');
  ASSERT_TRUE(Upload("ada", half).ok());
  ASSERT_TRUE(Upload("ada", half).ok()) << "it is there: nothing is added";
  ASSERT_TRUE(Upload("ada", other_half).ok());
  EXPECT_EQ(QuotasOf("ada").storage_bytes().used(), 1u << 20);
  ExpectRefused(Upload("ada", "c"), "STORAGE_USED_UP", "max_storage_bytes_per_user", "1048576", "1048576");
  ExpectRefused(TryCreate("ada"), "STORAGE_USED_UP", "max_storage_bytes_per_user", "1048576", "1048576");
  EXPECT_TRUE(Counts("STORAGE_USED_UP"));
  EXPECT_TRUE(Upload("bob", half).ok()) << "what is kept once counts for each";
  EXPECT_TRUE(TryCreate("bob", 16).ok());
  Restart();
  ExpectRefused(Upload("ada", "c"), "STORAGE_USED_UP", "max_storage_bytes_per_user", "1048576", "1048576");
  ASSERT_TRUE(DeleteScene("ada", half).ok());
  EXPECT_TRUE(Upload("ada", "c").ok());
  EXPECT_EQ(QuotasOf("ada").storage_bytes().used(), (512u << 10) + 1);
}

TEST_F(QuotaTest, StorageOfJobs) {
  StartWith({});
  ASSERT_TRUE(TryCreate("bob").ok());
  const double request = QuotasOf("bob").storage_bytes().used();
  EXPECT_GT(request, 100) << "of a job that has no result yet";
  ASSERT_TRUE(TryCreate("ada", 16).ok());
  const std::string job = job_.name();
  ASSERT_TRUE(Watch("ada", job).ok());
  const double whole = QuotasOf("ada").storage_bytes().used();
  EXPECT_GT(whole, request + 100) << "the result too";
  EXPECT_EQ(QuotasOf("gus").storage_bytes().used(), 0);
  Restart();
  EXPECT_EQ(QuotasOf("ada").storage_bytes().used(), whole);
  server_.reset();
  ASSERT_TRUE(database_->Execute("UPDATE jobs SET stored_bytes = NULL").ok());
  Restart();
  EXPECT_EQ(QuotasOf("ada").storage_bytes().used(), whole) << "jobs of an earlier version are measured";
  ASSERT_TRUE(Delete("ada", job).ok());
  EXPECT_EQ(QuotasOf("ada").storage_bytes().used(), 0);
}

TEST_F(QuotaTest, EachIsToldItsOwn) {
  StartWith({"student.jobs=5", "student.watches=none"});
  const v1::Quotas ada = QuotasOf("ada");
  EXPECT_EQ(ada.user(), "ada");
  EXPECT_EQ(ada.role(), "student");
  EXPECT_EQ(ada.jobs().limit(), 5);
  EXPECT_EQ(ada.cpu_seconds().limit(), 7200);
  EXPECT_FALSE(ada.watches().has_limit());
  EXPECT_EQ(ada.storage_bytes().limit(), 512u << 20);
  EXPECT_EQ(ada.requests().limit(), 500);
  EXPECT_EQ(ada.requests().used(), 1);
  EXPECT_EQ(ada.requests_per_second(), 50);
  EXPECT_EQ(QuotasOf("gus").role(), "grader");
  EXPECT_FALSE(QuotasOf("gus").cpu_seconds().has_limit());
}

}  // namespace
}  // namespace flatlight
