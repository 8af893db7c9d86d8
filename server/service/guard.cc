// SPDX-License-Identifier: Apache-2.0
#include "server/service/guard.h"

#include <openssl/crypto.h>

#include <string_view>

#include "server/store/error.h"
#include "server/store/sha256.h"

namespace flatlight {
namespace {

absl::Status Refuse(const std::string& message) {
  return MakeError(absl::StatusCode::kUnauthenticated, "BAD_TOKEN", message);
}

}  // namespace

Guard::Guard(const std::string& token) : token_hash_(token.empty() ? "" : Sha256Of(token)) {}

absl::StatusOr<Caller> Guard::Authorize(const grpc::ServerContextBase& context) const {
  if (token_hash_.empty()) return Caller{"anonymous"};
  const auto& metadata = context.client_metadata();
  const auto entry = metadata.find("authorization");
  if (entry == metadata.end()) return Refuse("this server wants the metadata authorization: Bearer TOKEN");
  constexpr std::string_view kScheme = "Bearer ";
  const std::string_view value(entry->second.data(), entry->second.size());
  if (!value.starts_with(kScheme)) return Refuse("the metadata authorization must be: Bearer TOKEN");
  // Hashes of equal length, compared in constant time: how long it takes tells nothing about the token.
  const std::string hash = Sha256Of(value.substr(kScheme.size()));
  if (CRYPTO_memcmp(hash.data(), token_hash_.data(), hash.size()) != 0) return Refuse("the token is not this server's");
  return Caller{"owner"};
}

}  // namespace flatlight
