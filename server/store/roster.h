// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_ROSTER_H_
#define FLATLIGHT_SERVER_STORE_ROSTER_H_

#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "server/store/user_store.h"

namespace flatlight {

// For UserStore::Add.
struct Roster {
  std::vector<User> users;
  std::vector<std::string> places;  // "class.csv:3".
};

// CSV as RFC 4180 has it, but with lines that end in LF or CRLF and no line breaks within fields. The first line names
// the columns: name, and if wanted role (student where empty) and groups (with ; between them). Empty lines are
// skipped. INVALID_ARGUMENT with ROSTER_INVALID.
absl::StatusOr<Roster> ParseRoster(const std::string& file, std::string_view text);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_ROSTER_H_
