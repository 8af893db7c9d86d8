// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_APP_USER_COMMANDS_H_
#define FLATLIGHT_SERVER_APP_USER_COMMANDS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace flatlight {

// flatlightd user …: on the folder of a server, which may be running; it heeds a change from the next call on.
struct UserCommand {
  enum class Action { kNone, kAdd, kList, kRevoke };
  Action action = Action::kNone;
  std::string name;  // Of whom to add or revoke.
  std::string role;  // Of whom to add.
  std::vector<std::string> groups;
  std::string roster;  // A CSV file of users to add, instead of `name`.
};

// What is to be printed, CSV: name and token of those added; name, role, groups and state of those listed. Makes the
// folder if it is missing, to add.
absl::StatusOr<std::string> RunUserCommand(const UserCommand& command, const std::string& data);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_APP_USER_COMMANDS_H_
