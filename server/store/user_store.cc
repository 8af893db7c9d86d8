// SPDX-License-Identifier: Apache-2.0
#include "server/store/user_store.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "server/store/error.h"
#include "server/store/random_bytes.h"
#include "server/store/sha256.h"

namespace flatlight {
namespace {

constexpr std::array<std::pair<Role, std::string_view>, kRoles> kRoleNames = {{
    {Role::kStudent, "student"},
    {Role::kGrader, "grader"},
    {Role::kInstructor, "instructor"},
    {Role::kAdmin, "admin"},
}};
constexpr std::size_t kMostNameBytes = 64;

// The beginning lets those who search for leaked secrets know one.
std::string MakeToken() { return "flatlight_" + RandomHex(32); }

bool IsWellFormed(std::string_view name) {
  const auto is_alphanumeric = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); };
  if (name.empty() || name.size() > kMostNameBytes || !is_alphanumeric(name.front())) return false;
  return std::all_of(name.begin(), name.end(),
                     [&](char c) { return is_alphanumeric(c) || c == '.' || c == '_' || c == '-' || c == '@'; });
}

absl::Status CheckName(const std::string& place, const std::string& what, const std::string& name) {
  if (name == kAnonymous || name == kServerOwner) {
    return MakeError(absl::StatusCode::kInvalidArgument, "USER_INVALID",
                     place + what + " \"" + name + "\" is the server's own: choose another");
  }
  if (IsWellFormed(name)) return absl::OkStatus();
  return MakeError(absl::StatusCode::kInvalidArgument, "USER_INVALID",
                   place + what + " \"" + name.substr(0, kMostNameBytes) +
                       "\" must be 1 to 64 of a-z, 0-9 and . _ - @, and begin with a letter or digit");
}

}  // namespace

std::string_view RoleName(Role role) { return kRoleNames[static_cast<std::size_t>(role)].second; }

std::vector<std::string> RoleNames() {
  std::vector<std::string> names;
  names.reserve(kRoles);
  for (const auto& [role, name] : kRoleNames) names.emplace_back(name);
  return names;
}

bool IsUserName(std::string_view name) { return IsWellFormed(name) && name != kAnonymous && name != kServerOwner; }

std::optional<Role> RoleOf(std::string_view name) {
  for (const auto& [role, its_name] : kRoleNames) {
    if (name == its_name) return role;
  }
  return std::nullopt;
}

absl::StatusOr<std::vector<std::string>> UserStore::Add(const std::vector<User>& users,
                                                        const std::vector<std::string>& places) {
  Transaction transaction(database_);
  if (absl::Status begun = transaction.Begin(); !begun.ok()) return begun;
  std::vector<std::string> tokens;
  for (std::size_t i = 0; i < users.size(); ++i) {
    auto token = AddOne(users[i], i < places.size() ? places[i] + ": " : "");
    if (!token.ok()) return token.status();
    tokens.push_back(*std::move(token));
  }
  if (absl::Status committed = transaction.Commit(); !committed.ok()) return committed;
  return tokens;
}

absl::StatusOr<std::string> UserStore::AddOne(const User& user, const std::string& place) {
  if (absl::Status named = CheckName(place, "the user name", user.name); !named.ok()) return named;
  std::string token = MakeToken();
  Statement insert = database_.Prepare(
      "INSERT INTO users(name, role, token_sha256) VALUES(?, ?, ?) ON CONFLICT(name) DO UPDATE SET "
      "role = excluded.role, token_sha256 = excluded.token_sha256 WHERE users.token_sha256 IS NULL");
  insert.Bind(std::string_view(user.name)).Bind(RoleName(user.role));
  if (absl::Status done = insert.Bind(std::string_view(Sha256Of(token))).Run(); !done.ok()) return done;
  if (database_.changed_rows() == 0) {
    return MakeError(absl::StatusCode::kAlreadyExists, "USER_EXISTS",
                     place + "there is a user \"" + user.name + "\" already: revoke it first to give it a new token");
  }
  Statement clear = database_.Prepare("DELETE FROM memberships WHERE user = ?");
  if (absl::Status done = clear.Bind(std::string_view(user.name)).Run(); !done.ok()) return done;
  for (const std::string& group : std::set<std::string>(user.groups.begin(), user.groups.end())) {
    if (absl::Status named = CheckName(place, "the group name", group); !named.ok()) return named;
    Statement join = database_.Prepare("INSERT INTO memberships(user, group_name) VALUES(?, ?)");
    absl::Status done = join.Bind(std::string_view(user.name)).Bind(std::string_view(group)).Run();
    if (!done.ok()) return done;
  }
  return token;
}

absl::StatusOr<std::vector<std::string>> UserStore::GroupsOf(const std::string& name) {
  Statement rows = database_.Prepare("SELECT group_name FROM memberships WHERE user = ? ORDER BY group_name");
  rows.Bind(std::string_view(name));
  std::vector<std::string> groups;
  absl::Status read = rows.ForEachRow([&](const Statement& row) { groups.push_back(row.Bytes(0)); });
  if (!read.ok()) return read;
  return groups;
}

absl::StatusOr<std::vector<User>> UserStore::List() {
  Statement rows = database_.Prepare("SELECT name, role, token_sha256 IS NULL FROM users ORDER BY name");
  std::vector<User> users;
  while (true) {
    const auto row = rows.Step();
    if (!row.ok()) return row.status();
    if (!*row) return users;
    auto groups = GroupsOf(rows.Bytes(0));
    if (!groups.ok()) return groups.status();
    const auto role = RoleOf(rows.Bytes(1)).value_or(Role::kStudent);
    users.push_back({rows.Bytes(0), role, *std::move(groups), rows.Integer(2) != 0});
  }
}

absl::Status UserStore::Revoke(const std::string& name) {
  Statement revoke = database_.Prepare("UPDATE users SET token_sha256 = NULL WHERE name = ?");
  if (absl::Status done = revoke.Bind(std::string_view(name)).Run(); !done.ok()) return done;
  if (database_.changed_rows() > 0) return absl::OkStatus();
  return MakeError(absl::StatusCode::kNotFound, "USER_NOT_FOUND", "there is no user \"" + name + "\"");
}

absl::StatusOr<User> UserStore::Authenticate(std::string_view token) { return FindByTokenHash(Sha256Of(token)); }

absl::StatusOr<User> UserStore::FindByTokenHash(const std::string& token_sha256) {
  // What is compared is a hash, whose timing tells nothing of the token.
  Statement rows = database_.Prepare("SELECT name, role FROM users WHERE token_sha256 = ?");
  const auto row = rows.Bind(std::string_view(token_sha256)).Step();
  if (!row.ok()) return row.status();
  if (!*row) {
    return MakeError(absl::StatusCode::kUnauthenticated, "TOKEN_INVALID",
                     "the token is not known here, or was revoked: ask whoever runs the server for a new one");
  }
  auto groups = GroupsOf(rows.Bytes(0));
  if (!groups.ok()) return groups.status();
  return User{rows.Bytes(0), RoleOf(rows.Bytes(1)).value_or(Role::kStudent), *std::move(groups), false};
}

absl::StatusOr<std::optional<Role>> UserStore::FindRole(const std::string& name) {
  Statement rows = database_.Prepare("SELECT role FROM users WHERE name = ?");
  const auto row = rows.Bind(std::string_view(name)).Step();
  if (!row.ok()) return row.status();
  if (!*row) return std::optional<Role>();
  return RoleOf(rows.Bytes(0));
}

absl::StatusOr<bool> UserStore::HasUsers() { return database_.Prepare("SELECT 1 FROM users LIMIT 1").Step(); }

}  // namespace flatlight
