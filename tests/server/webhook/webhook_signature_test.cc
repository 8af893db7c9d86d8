// SPDX-License-Identifier: Apache-2.0
#include "server/webhook/webhook_signature.h"

#include <gtest/gtest.h>

namespace flatlight {
namespace {

// As computed by another program: printf 'ended_1.1614265330.{"test": 2432232314}' | openssl dgst -sha256 -hmac
// 0123456789abcdef0123456789abcdef -binary | base64
TEST(WebhookSignature, IsTheHmacOfIdTimestampAndBody) {
  const std::string secret = "0123456789abcdef0123456789abcdef";
  EXPECT_EQ(WebhookSignature(secret, "ended_1", 1614265330, R"({"test": 2432232314})"),
            "v1,lOlG+R1Y2ZkaEwVmn0JgIhDgXBGhsVVxuJ7x4m2s0us=");
  EXPECT_EQ(WebhookSecretText(secret), "whsec_MDEyMzQ1Njc4OWFiY2RlZjAxMjM0NTY3ODlhYmNkZWY=");
}

TEST(WebhookSignature, EachUserHasASecretOfItsOwn) {
  const std::string key(32, 'k');
  EXPECT_EQ(WebhookSecret(key, "ada", 0).size(), 32u);
  EXPECT_EQ(WebhookSecret(key, "ada", 3), WebhookSecret(key, "ada", 3));
  EXPECT_NE(WebhookSecret(key, "ada", 0), WebhookSecret(key, "bob", 0));
  EXPECT_NE(WebhookSecret(key, "ada", 0), WebhookSecret(std::string(32, 'l'), "ada", 0));
  EXPECT_NE(WebhookSecret(key, "ada", 0), WebhookSecret(key, "ada", 1));
  EXPECT_NE(WebhookSecret(key, "ada", 1), WebhookSecret(key, "ada", 2));
}

// printf 'webhooks of ada' | openssl dgst -sha256 -hmac kkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkk -binary | base64: what
// receivers were given before secrets could be rotated is good still.
TEST(WebhookSignature, TheFirstSecretIsThatOfBefore) {
  EXPECT_EQ(WebhookSecretText(WebhookSecret(std::string(32, 'k'), "ada", 0)),
            "whsec_wsC5xyPoM3qTYeU2HIhM94DhemjVMVot2TIJepGw9aU=");
}

}  // namespace
}  // namespace flatlight
