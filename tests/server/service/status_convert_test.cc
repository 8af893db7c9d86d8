// SPDX-License-Identifier: Apache-2.0
#include "server/service/status_convert.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/store/error.h"
#include "tests/support/loopback/loopback_server.h"

namespace flatlight {
namespace {

using testing::DetailOf;

TEST(StatusConvert, ErrorsSayWhy) {
  const grpc::Status status = ToGrpcStatus(MakeError(absl::StatusCode::kNotFound, "JOB_NOT_FOUND", "no such job"));
  EXPECT_EQ(status.error_code(), grpc::StatusCode::NOT_FOUND);
  EXPECT_EQ(status.error_message(), "no such job");
  const auto info = DetailOf<google::rpc::ErrorInfo>(status);
  ASSERT_TRUE(info);
  EXPECT_EQ(info->reason(), "JOB_NOT_FOUND");
  EXPECT_EQ(info->domain(), "flatlight");
}

TEST(StatusConvert, OkIsOk) { EXPECT_TRUE(ToGrpcStatus(absl::OkStatus()).ok()); }

TEST(StatusConvert, QuotasSayWhichAndWhenToTryAgain) {
  const grpc::Status status =
      ToGrpcStatus(MakeQuotaError("TOO_MANY_JOBS", "max_jobs", "full", std::chrono::milliseconds(1500)));
  EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(DetailOf<google::rpc::QuotaFailure>(status)->violations(0).subject(), "max_jobs");
  const auto retry = DetailOf<google::rpc::RetryInfo>(status);
  EXPECT_EQ(retry->retry_delay().seconds(), 1);
  EXPECT_EQ(retry->retry_delay().nanos(), 500'000'000);
}

TEST(StatusConvert, AServerThatEndsSaysWhenToTryAgain) {
  const grpc::Status status = ToGrpcStatus(MakeDrainingError());
  EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(DetailOf<google::rpc::RetryInfo>(status)->retry_delay().seconds(), 2);
  EXPECT_FALSE(DetailOf<google::rpc::QuotaFailure>(status));
}

// What a gRPC client counts against its 8 KiB: message, percent-encoded, and details in base64.
std::size_t TrailerBytes(const grpc::Status& status) {
  return 3 * status.error_message().size() + (status.error_details().size() + 2) / 3 * 4;
}

TEST(StatusConvert, TheWorstErrorFitsIntoTrailers) {
  std::string umlauts;
  for (int i = 0; i < 5000; ++i) umlauts += "\xc3\xbc";
  Diagnostics diagnostics;
  for (int i = 0; i < 2000; ++i) diagnostics.Add(umlauts, umlauts);
  const grpc::Status status = ToGrpcStatus(MakeDiagnosticsError("BAD_SCENE", "the scene", diagnostics));
  EXPECT_LT(TrailerBytes(status), 7900u);
  const auto bad = DetailOf<google::rpc::BadRequest>(status);
  ASSERT_TRUE(bad);
  ASSERT_GT(bad->field_violations_size(), 0);
  const std::string& field = bad->field_violations(0).field();
  EXPECT_THAT(field, ::testing::EndsWith("\xbc...")) << "cut between characters";
  EXPECT_EQ(std::stoi(DetailOf<google::rpc::ErrorInfo>(status)->metadata().at("more_violations")),
            2000 - bad->field_violations_size());
}

TEST(StatusConvert, ShortListsAreWhole) {
  Diagnostics diagnostics;
  for (int i = 0; i < 10; ++i) diagnostics.Add("plane.curves[" + std::to_string(i) + "].material", "missing");
  const grpc::Status status = ToGrpcStatus(MakeDiagnosticsError("BAD_SCENE", "the scene", diagnostics));
  EXPECT_EQ(DetailOf<google::rpc::BadRequest>(status)->field_violations_size(), 10);
  EXPECT_EQ(DetailOf<google::rpc::ErrorInfo>(status)->metadata().count("more_violations"), 0u);
  EXPECT_EQ(status.error_message(), "the scene has 10 mistakes, first: plane.curves[0].material: missing");
}

}  // namespace
}  // namespace flatlight
