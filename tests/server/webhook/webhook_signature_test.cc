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
  EXPECT_EQ(WebhookSecret(key, "ada").size(), 32u);
  EXPECT_EQ(WebhookSecret(key, "ada"), WebhookSecret(key, "ada"));
  EXPECT_NE(WebhookSecret(key, "ada"), WebhookSecret(key, "bob"));
  EXPECT_NE(WebhookSecret(key, "ada"), WebhookSecret(std::string(32, 'l'), "ada"));
}

}  // namespace
}  // namespace flatlight
