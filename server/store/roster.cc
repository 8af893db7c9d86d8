// SPDX-License-Identifier: Apache-2.0
#include "server/store/roster.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "server/store/error.h"

namespace flatlight {
namespace {

absl::Status Invalid(const std::string& place, const std::string& message) {
  return MakeError(absl::StatusCode::kInvalidArgument, "ROSTER_INVALID", place + ": " + message);
}

absl::StatusOr<std::vector<std::string>> SplitFields(const std::string& place, std::string_view line) {
  std::vector<std::string> fields;
  std::size_t at = 0;
  while (true) {
    std::string field;
    if (at < line.size() && line[at] == '"') {
      ++at;
      while (true) {
        if (at == line.size()) return Invalid(place, "a quoted field has no closing \"");
        if (line[at] == '"' && (++at == line.size() || line[at] != '"')) break;
        field += line[at++];
      }
      if (at < line.size() && line[at] != ',') return Invalid(place, "a comma must follow a closing \"");
    } else {
      const std::size_t end = std::min(line.find(',', at), line.size());
      field = line.substr(at, end - at);
      if (field.find('"') != std::string::npos) return Invalid(place, "a field with \" in it must be quoted");
      at = end;
    }
    fields.push_back(std::move(field));
    if (at == line.size()) return fields;
    ++at;
  }
}

absl::Status CheckColumns(const std::string& place, const std::vector<std::string>& columns) {
  for (const std::string& column : columns) {
    if (column != "name" && column != "role" && column != "groups") {
      return Invalid(place, "the column \"" + column + "\" must be name, role or groups");
    }
    if (std::count(columns.begin(), columns.end(), column) > 1) {
      return Invalid(place, "the column \"" + column + "\" is there twice");
    }
  }
  if (std::count(columns.begin(), columns.end(), "name") == 1) return absl::OkStatus();
  return Invalid(place, "there must be a column \"name\"");
}

std::vector<std::string> SplitGroups(std::string_view text) {
  std::vector<std::string> groups;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(';', at), text.size());
    if (end > at) groups.emplace_back(text.substr(at, end - at));
    at = end + 1;
  }
  return groups;
}

absl::StatusOr<User> ReadUser(const std::string& place, const std::vector<std::string>& columns,
                              const std::vector<std::string>& fields) {
  if (fields.size() != columns.size()) {
    return Invalid(place, "has " + std::to_string(fields.size()) + " fields; the first line has " +
                              std::to_string(columns.size()));
  }
  User user;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i] == "name") user.name = fields[i];
    if (columns[i] == "groups") user.groups = SplitGroups(fields[i]);
    if (columns[i] != "role" || fields[i].empty()) continue;
    const auto role = RoleOf(fields[i]);
    if (!role) return Invalid(place, "the role \"" + fields[i] + "\" must be student, grader, instructor or admin");
    user.role = *role;
  }
  return user;
}

}  // namespace

absl::StatusOr<Roster> ParseRoster(const std::string& file, std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark) text.remove_prefix(kByteOrderMark.size());
  Roster roster;
  std::optional<std::vector<std::string>> columns;
  for (std::size_t at = 0, number = 1; at < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, end - at);
    at = end + 1;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.empty()) continue;
    const std::string place = file + ":" + std::to_string(number);
    auto fields = SplitFields(place, line);
    if (!fields.ok()) return fields.status();
    if (!columns) {
      if (absl::Status checked = CheckColumns(place, *fields); !checked.ok()) return checked;
      columns = *std::move(fields);
      continue;
    }
    auto user = ReadUser(place, *columns, *fields);
    if (!user.ok()) return user.status();
    roster.users.push_back(*std::move(user));
    roster.places.push_back(place);
  }
  if (roster.users.empty()) return Invalid(file, "names no users");
  return roster;
}

}  // namespace flatlight
