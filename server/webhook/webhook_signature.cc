// SPDX-License-Identifier: Apache-2.0
#include "server/webhook/webhook_signature.h"

#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <array>

#include "absl/strings/escaping.h"

namespace flatlight {
namespace {

std::string Hmac(const std::string& key, const std::string& text) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()), reinterpret_cast<const unsigned char*>(text.data()),
       text.size(), digest.data(), &size);
  return {reinterpret_cast<const char*>(digest.data()), size};
}

}  // namespace

std::string WebhookId(const std::string& job_uuid) { return "ended_" + job_uuid; }

std::string WebhookSecret(const std::string& key, const std::string& user, std::int64_t generation) {
  // No user's name has a line's end. The first secrets are from before there were generations.
  return Hmac(key, "webhooks of " + user + (generation == 0 ? "" : "\n" + std::to_string(generation)));
}

std::string WebhookSecretText(const std::string& secret) { return "whsec_" + absl::Base64Escape(secret); }

std::string WebhookSignature(const std::string& secret, const std::string& id, std::int64_t timestamp,
                             const std::string& body) {
  return "v1," + absl::Base64Escape(Hmac(secret, id + "." + std::to_string(timestamp) + "." + body));
}

}  // namespace flatlight
