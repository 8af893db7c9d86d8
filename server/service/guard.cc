// SPDX-License-Identifier: Apache-2.0
#include "server/service/guard.h"

#include <openssl/crypto.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <utility>

#include "server/store/error.h"
#include "server/store/sha256.h"

namespace flatlight {
namespace {

absl::Status Refuse(const std::string& message) {
  return MakeError(absl::StatusCode::kUnauthenticated, "BAD_TOKEN", message);
}

std::string FewDigits(double value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

}  // namespace

Guard::Guard(const std::string& token, std::unique_ptr<Database> users, const QuotaTable& quotas, const Clock& clock)
    : token_hash_(token.empty() ? "" : Sha256Of(token)),
      users_(users == nullptr ? nullptr : std::make_unique<UserDirectory>(std::move(users))),
      quotas_(quotas),
      requests_(clock) {}

absl::Status Guard::Admit(const Caller& caller, std::string_view request) const {
  if (absl::Status allowed = CheckRole(caller, request); !allowed.ok()) return allowed;
  return TakeRequest(caller);
}

absl::Status Guard::TakeRequest(const Caller& caller) const {
  const auto& a_second = QuotasOf(caller).requests;
  if (!a_second) return absl::OkStatus();
  const auto wait = requests_.Take(caller.name, *a_second);
  if (!wait) return absl::OkStatus();
  const double at_once = RequestsAtOnce(*a_second);
  const auto number = [](double value) { return std::to_string(static_cast<std::int64_t>(value)); };
  return MakeQuotaError("TOO_MANY_REQUESTS", "max_requests_per_user",
                        "you have made " + number(at_once) + " requests at once; allowed: " + number(at_once) +
                            ", and " + FewDigits(*a_second) + " more a second",
                        std::chrono::ceil<std::chrono::milliseconds>(*wait), QuotaUse{at_once, at_once});
}

const Quotas& Guard::QuotasOf(const std::string& owner) const {
  if (owner == kAnonymous || owner == kServerOwner || users_ == nullptr) return quotas_.Of(Role::kAdmin);
  const auto role = users_->FindRole(owner);
  return quotas_.Of(role.ok() ? role->value_or(Role::kStudent) : Role::kStudent);
}

double Guard::RequestsTaken(const Caller& caller) const {
  const auto& a_second = QuotasOf(caller).requests;
  return a_second ? requests_.Taken(caller.name, *a_second) : 0;
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

absl::StatusOr<Caller> Guard::Identify(const grpc::ServerContextBase& context) const {
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
  std::string hash = Sha256Of(token);
  if (!token_hash_.empty() && CRYPTO_memcmp(hash.data(), token_hash_.data(), hash.size()) == 0) {
    return Caller{std::string(kServerOwner), Role::kAdmin, {}};
  }
  if (!*has_users) return Refuse("the token is not this server's");
  auto user = users_->FindByTokenHash(hash);
  if (!user.ok()) return user.status();
  return Caller{std::move(user->name), user->role, std::move(user->groups), std::move(hash)};
}

}  // namespace flatlight
