// SPDX-License-Identifier: Apache-2.0
#include "server/store/user_directory.h"

#include <utility>

namespace flatlight {

UserDirectory::UserDirectory(std::unique_ptr<Database> database)
    : database_(std::move(database)), version_query_(database_->Prepare("SELECT version FROM users_version")) {}

absl::StatusOr<std::int64_t> UserDirectory::ReadVersion() {
  const auto row = version_query_.Step();
  const std::int64_t version = row.ok() && *row ? version_query_.Integer(0) : 0;
  version_query_.Reset();
  if (!row.ok()) return row.status();
  return version;
}

absl::Status UserDirectory::ForgetWhatChanged() {
  const auto header = database_->ReadLogHeader();
  if (header && header == seen_) return absl::OkStatus();
  const auto version = ReadVersion();
  if (!version.ok()) return version.status();
  seen_ = header;
  if (*version == version_) return absl::OkStatus();
  version_ = *version;
  by_token_hash_.clear();
  if (has_users_ == false) has_users_.reset();
  return absl::OkStatus();
}

absl::StatusOr<std::optional<Role>> UserDirectory::FindRole(const std::string& name) {
  const std::lock_guard lock(mutex_);
  return UserStore(*database_).FindRole(name);
}

std::int64_t UserDirectory::Version() {
  const std::lock_guard lock(mutex_);
  return ForgetWhatChanged().ok() ? version_ : --unreadable_;
}

absl::StatusOr<bool> UserDirectory::HasUsers() {
  if (ever_had_users_) return true;
  const std::lock_guard lock(mutex_);
  if (absl::Status looked = ForgetWhatChanged(); !looked.ok()) return looked;
  if (has_users_) return *has_users_;
  auto some = UserStore(*database_).HasUsers();
  if (!some.ok()) return some;
  has_users_ = *some;
  ever_had_users_ = *some;
  return some;
}

absl::StatusOr<User> UserDirectory::FindByTokenHash(const std::string& token_sha256) {
  const std::lock_guard lock(mutex_);
  if (absl::Status looked = ForgetWhatChanged(); !looked.ok()) return looked;
  if (const auto known = by_token_hash_.find(token_sha256); known != by_token_hash_.end()) return known->second;
  auto user = UserStore(*database_).FindByTokenHash(token_sha256);
  // Guesses are not remembered: there is no end of them.
  if (!user.ok()) return user;
  if (by_token_hash_.size() >= kMostRemembered) by_token_hash_.clear();
  by_token_hash_.emplace(token_sha256, *user);
  return user;
}

}  // namespace flatlight
