// SPDX-License-Identifier: Apache-2.0
#include "server/app/user_commands.h"

#include <cerrno>
#include <fstream>
#include <iterator>
#include <memory>

#include "server/store/blob_files.h"
#include "server/store/database.h"
#include "server/store/error.h"
#include "server/store/roster.h"
#include "server/store/schema.h"
#include "server/store/storage.h"
#include "server/store/user_store.h"

namespace flatlight {
namespace {

absl::StatusOr<std::unique_ptr<Database>> OpenUsers(const UserCommand& command, const std::string& data) {
  const std::string path = Storage::DatabasePath(data);
  const bool may_make = command.action == UserCommand::Action::kAdd;
  if (may_make) {
    if (absl::Status made = MakeFolder(data); !made.ok()) return made;
  }
  auto database = may_make ? Database::Open(path) : Database::OpenExisting(path);
  if (!database.ok()) return database;
  if (absl::Status migrated = Migrate(**database); !migrated.ok()) return migrated;
  return database;
}

absl::StatusOr<Roster> UsersToAdd(const UserCommand& command) {
  if (!command.roster.empty()) {
    std::ifstream file(command.roster, std::ios::binary);
    if (!file) return StorageError(command.roster, errno);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    return ParseRoster(command.roster, text);
  }
  return Roster{{User{command.name, RoleOf(command.role).value_or(Role::kStudent), command.groups}}, {}};
}

absl::StatusOr<std::string> Add(const UserCommand& command, UserStore& store) {
  const auto roster = UsersToAdd(command);
  if (!roster.ok()) return roster.status();
  const auto tokens = store.Add(roster->users, roster->places);
  if (!tokens.ok()) return tokens.status();
  std::string text = "name,token\n";
  for (std::size_t i = 0; i < tokens->size(); ++i) text += roster->users[i].name + "," + (*tokens)[i] + "\n";
  return text;
}

absl::StatusOr<std::string> List(UserStore& store) {
  const auto users = store.List();
  if (!users.ok()) return users.status();
  std::string text = "name,role,groups,state\n";
  for (const User& user : *users) {
    text += user.name + "," + std::string(RoleName(user.role)) + ",";
    for (const std::string& group : user.groups) text += (&group == &user.groups.front() ? "" : ";") + group;
    text += user.revoked ? ",revoked\n" : ",active\n";
  }
  return text;
}

}  // namespace

absl::StatusOr<std::string> RunUserCommand(const UserCommand& command, const std::string& data) {
  const auto database = OpenUsers(command, data);
  if (!database.ok()) return database.status();
  UserStore store(**database);
  switch (command.action) {
    case UserCommand::Action::kAdd:
      return Add(command, store);
    case UserCommand::Action::kRevoke:
      if (absl::Status revoked = store.Revoke(command.name); !revoked.ok()) return revoked;
      return "";
    case UserCommand::Action::kList:
    case UserCommand::Action::kNone:
      break;
  }
  return List(store);
}

}  // namespace flatlight
