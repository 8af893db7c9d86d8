// SPDX-License-Identifier: Apache-2.0
#include "server/service/message_bytes.h"

#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/status/status.h"
#include "flatlight/v1/server_service.pb.h"
#include "tests/support/status/status_matchers.h"

namespace flatlight {
namespace {

using ::testing::_;
using ::testing::HasSubstr;

TEST(MessageBytesTest, EmptyMessagesAreMessages) {
  v1::RotateWebhookSecretRequest request;
  EXPECT_THAT(FromBytes(ToBytes(request), request), testing::IsOk());
}

// A caller that was cut off, or that ended its side without a message, has asked for nothing.
TEST(MessageBytesTest, WhatNeverCameIsNoMessage) {
  v1::RotateWebhookSecretRequest request;
  EXPECT_THAT(FromBytes(grpc::ByteBuffer(), request),
              testing::StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("RotateWebhookSecretRequest")));
}

TEST(MessageBytesTest, OneMessageInSeveralPiecesIsOne) {
  v1::RotateWebhookSecretRequest request;
  request.set_keep_earlier_seconds(12345);
  const std::string bytes = request.SerializeAsString();
  ASSERT_GT(bytes.size(), 1u);
  const grpc::Slice pieces[2] = {grpc::Slice(bytes.substr(0, 1)), grpc::Slice(bytes.substr(1))};
  v1::RotateWebhookSecretRequest read;
  EXPECT_THAT(FromBytes(grpc::ByteBuffer(pieces, 2), read), testing::IsOk());
  EXPECT_EQ(read.keep_earlier_seconds(), 12345);
  EXPECT_THAT(FromBytes(grpc::ByteBuffer(pieces, 1), read), testing::StatusIs(absl::StatusCode::kInvalidArgument, _));
}

}  // namespace
}  // namespace flatlight
