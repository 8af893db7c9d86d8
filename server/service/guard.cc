// SPDX-License-Identifier: Apache-2.0
#include "server/service/guard.h"

#include <openssl/crypto.h>

#include <utility>

#include "server/store/error.h"
#include "server/store/sha256.h"

namespace flatlight {
namespace {

absl::Status Refuse(const std::string& message) {
  return MakeError(absl::StatusCode::kUnauthenticated, "BAD_TOKEN", message);
}

}  // namespace

Guard::Guard(const std::string& token, std::unique_ptr<Database> users)
    : token_hash_(token.empty() ? "" : Sha256Of(token)),
      users_(users == nullptr ? nullptr : std::make_unique<UserDirectory>(std::move(users))) {}

absl::StatusOr<Caller> Guard::Authorize(const grpc::ServerContextBase& context, std::string_view request) const {
  auto caller = Authenticate(context);
  if (!caller.ok()) return caller;
  if (absl::Status allowed = CheckRole(*caller, request); !allowed.ok()) return allowed;
  return caller;
}

absl::Status Guard::Recheck(const Caller& caller) const {
  if (caller.token_sha256.empty()) {
    if (caller.name != kAnonymous) return absl::OkStatus();
    const auto has_users = HasUsers();
    if (!has_users.ok()) return has_users.status();
    if (!*has_users) return absl::OkStatus();
    return Refuse("this server has users now, and wants the metadata authorization: Bearer TOKEN");
  }
  const auto user = users_->FindByTokenHash(caller.token_sha256);
  if (!user.ok()) return user.status();
  if (user->role == caller.role && user->groups == caller.groups) return absl::OkStatus();
  return MakeError(absl::StatusCode::kPermissionDenied, "RIGHTS_CHANGED",
                   "what " + caller.name + " may do has changed; call again");
}

std::int64_t Guard::UsersVersion() const { return users_ == nullptr ? 0 : users_->Version(); }

absl::StatusOr<bool> Guard::KnowsEverybody() const {
  if (!token_hash_.empty()) return true;
  return HasUsers();
}

absl::StatusOr<bool> Guard::HasUsers() const {
  if (users_ == nullptr) return false;
  return users_->HasUsers();
}

absl::StatusOr<Caller> Guard::Authenticate(const grpc::ServerContextBase& context) const {
  const auto has_users = HasUsers();
  if (!has_users.ok()) return has_users.status();
  if (token_hash_.empty() && !*has_users) return Caller{std::string(kAnonymous), Role::kAdmin, {}};
  const auto& metadata = context.client_metadata();
  const auto entry = metadata.find("authorization");
  if (entry == metadata.end()) return Refuse("this server wants the metadata authorization: Bearer TOKEN");
  constexpr std::string_view kScheme = "Bearer ";
  const std::string_view value(entry->second.data(), entry->second.size());
  if (!value.starts_with(kScheme)) return Refuse("the metadata authorization must be: Bearer TOKEN");
  const std::string_view token = value.substr(kScheme.size());
  // Hashes of equal length, compared in constant time: how long it takes tells nothing about the token.
  const std::string hash = Sha256Of(token);
  if (!token_hash_.empty() && CRYPTO_memcmp(hash.data(), token_hash_.data(), hash.size()) == 0) {
    return Caller{std::string(kServerOwner), Role::kAdmin, {}};
  }
  if (!*has_users) return Refuse("the token is not this server's");
  auto user = users_->FindByTokenHash(hash);
  if (!user.ok()) return user.status();
  return Caller{std::move(user->name), user->role, std::move(user->groups), hash};
}

}  // namespace flatlight
