// SPDX-License-Identifier: Apache-2.0
#include "client/cli/connection/retry.h"

#include <gtest/gtest.h>

#include "flatlight/v1/render_service.pb.h"
#include "flatlight/v1/review_service.pb.h"
#include "flatlight/v1/scene_service.pb.h"
#include "flatlight/v1/server_service.pb.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/error_info.pb.h"
#include "google/rpc/status.pb.h"

namespace flatlight {
namespace {

using std::chrono::milliseconds;

// As a server refuses a call.
grpc::Status Refusal(grpc::StatusCode code, const std::string& reason, std::optional<int> retry_milliseconds) {
  google::rpc::Status details;
  google::rpc::ErrorInfo info;
  info.set_reason(reason);
  if (retry_milliseconds) {
    google::rpc::RetryInfo retry;
    retry.mutable_retry_delay()->set_seconds(*retry_milliseconds / 1000);
    retry.mutable_retry_delay()->set_nanos(*retry_milliseconds % 1000 * 1'000'000);
    details.add_details()->PackFrom(retry);
  }
  details.add_details()->PackFrom(info);
  return {code, "refused", details.SerializeAsString()};
}

const grpc::Status kLost(grpc::StatusCode::UNAVAILABLE, "Socket closed");

TEST(RetryTest, WhatTheServerPutOffIsMadeAgainNotSoonerThanItSays) {
  for (const bool repeatable : {false, true}) {
    Retry retry(repeatable);
    const grpc::Status refusal = Refusal(grpc::StatusCode::RESOURCE_EXHAUSTED, "TOO_MANY_JOBS", 2000);
    EXPECT_EQ(retry.Next(refusal, 0), milliseconds(2001));
    EXPECT_EQ(retry.Next(refusal, 0.8), milliseconds(2401));
    EXPECT_EQ(retry.why(), "the server refuses for now (TOO_MANY_JOBS)");
    EXPECT_TRUE(Retry(repeatable).Next(Refusal(grpc::StatusCode::UNAVAILABLE, "DRAINING", 2000), 0));
  }
}

TEST(RetryTest, WhatTakesLongIsForTheUser) {
  EXPECT_TRUE(Retry(true).Next(Refusal(grpc::StatusCode::RESOURCE_EXHAUSTED, "STORAGE_USED_UP", 10'000), 0));
  EXPECT_FALSE(Retry(true).Next(Refusal(grpc::StatusCode::RESOURCE_EXHAUSTED, "STORAGE_USED_UP", 10'001), 0));
  EXPECT_FALSE(Retry(true).Next(Refusal(grpc::StatusCode::RESOURCE_EXHAUSTED, "STORAGE_FULL", std::nullopt), 0));
  EXPECT_FALSE(Retry(true).Next(Refusal(grpc::StatusCode::UNAVAILABLE, "STORAGE_READ_ONLY", std::nullopt), 0));
}

TEST(RetryTest, OnlyWhatMayBeDoneTwiceIsMadeAgainWithoutAnAnswer) {
  EXPECT_FALSE(Retry(false).Next(kLost, 0));
  Retry retry(true);
  EXPECT_EQ(retry.Next(kLost, 0), milliseconds(125));
  EXPECT_EQ(retry.Next(kLost, 0.5), milliseconds(375));
  EXPECT_EQ(retry.why(), "no answer from the server");
}

TEST(RetryTest, OtherErrorsAreFinal) {
  for (const auto code : {grpc::StatusCode::INVALID_ARGUMENT, grpc::StatusCode::NOT_FOUND, grpc::StatusCode::INTERNAL,
                          grpc::StatusCode::UNAUTHENTICATED, grpc::StatusCode::DEADLINE_EXCEEDED}) {
    EXPECT_FALSE(Retry(true).Next(Refusal(code, "REASON", 1), 0)) << code;
  }
}

TEST(RetryTest, TriesAreFew) {
  Retry retry(true);
  int waits = 0;
  while (retry.Next(waits % 2 == 0 ? kLost : Refusal(grpc::StatusCode::RESOURCE_EXHAUSTED, "BUSY", 1), 0)) ++waits;
  EXPECT_EQ(waits, Retry::kMostTries - 1);
}

TEST(RetryTest, WaitsDoubleWithinBounds) {
  const auto wait = [](int failures, double chance) {
    return DoublingWait(milliseconds(50), milliseconds(2000), failures, chance).count();
  };
  EXPECT_EQ(wait(1, 0), 25);
  EXPECT_EQ(wait(1, 0.99), 49);
  EXPECT_EQ(wait(3, 0), 100);
  EXPECT_EQ(wait(1000000, 0.5), 1500);
}

TEST(RetryTest, WhatMayBeDoneTwiceIsWhatTheApiSays) {
  EXPECT_TRUE(IsRepeatable(v1::GetJobRequest()));
  EXPECT_TRUE(IsRepeatable(v1::CancelJobRequest()));
  EXPECT_TRUE(IsRepeatable(v1::UploadSceneRequest()));
  EXPECT_TRUE(IsRepeatable(v1::GetCapabilitiesRequest()));
  EXPECT_FALSE(IsRepeatable(v1::DeleteJobRequest())) << "the second time there is no such job";
  EXPECT_FALSE(IsRepeatable(v1::CreateRoomRequest()));
  v1::CreateJobRequest create;
  v1::AddNoteRequest note;
  EXPECT_FALSE(IsRepeatable(create));
  EXPECT_FALSE(IsRepeatable(note));
  create.set_request_id("5f0d8c5e-6a3a-4a57-9c6f-000000000001");
  note.set_request_id(create.request_id());
  EXPECT_TRUE(IsRepeatable(create));
  EXPECT_TRUE(IsRepeatable(note));
}

}  // namespace
}  // namespace flatlight
