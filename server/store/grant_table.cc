// SPDX-License-Identifier: Apache-2.0
#include "server/store/grant_table.h"

#include <string_view>

namespace flatlight {
namespace {

constexpr std::string_view kControl = "control";
constexpr std::string_view kRead = "read";

}  // namespace

absl::StatusOr<std::vector<Grant>> ReadGrants(Database& database, const std::string& resource) {
  Statement rows = database.Prepare("SELECT grantee, access FROM grants WHERE resource = ? ORDER BY grantee");
  rows.Bind(std::string_view(resource));
  std::vector<Grant> grants;
  absl::Status read = rows.ForEachRow([&](const Statement& row) {
    const auto grantee = Grantee::Parse(row.Bytes(0));
    if (grantee) grants.push_back({*grantee, row.Bytes(1) == kControl ? Access::kControl : Access::kRead});
  });
  if (!read.ok()) return read;
  return grants;
}

absl::Status InsertGrant(Database& database, const std::string& resource, const Grant& grant) {
  auto grants = ReadGrants(database, resource);
  if (!grants.ok()) return grants.status();
  if (absl::Status added = AddGrant(resource, grant, *grants); !added.ok()) return added;
  return database.Prepare("INSERT OR REPLACE INTO grants(resource, grantee, access) VALUES(?, ?, ?)")
      .Bind(std::string_view(resource))
      .Bind(std::string_view(grant.grantee.text()))
      .Bind(grant.access == Access::kControl ? kControl : kRead)
      .Run();
}

absl::Status DeleteGrant(Database& database, const std::string& resource, const Grantee& grantee) {
  auto grants = ReadGrants(database, resource);
  if (!grants.ok()) return grants.status();
  if (absl::Status removed = RemoveGrant(resource, grantee, *grants); !removed.ok()) return removed;
  return database.Prepare("DELETE FROM grants WHERE resource = ? AND grantee = ?")
      .Bind(std::string_view(resource))
      .Bind(std::string_view(grantee.text()))
      .Run();
}

std::string ResourcesOf(const std::vector<Grantee>& who) {
  std::string places;
  for (std::size_t i = 0; i < who.size(); ++i) places += i == 0 ? "?" : ", ?";
  return "(SELECT resource FROM grants WHERE grantee IN (" + places + "))";
}

void BindGrantees(const std::vector<Grantee>& who, Statement& statement) {
  for (const Grantee& grantee : who) statement.Bind(std::string_view(grantee.text()));
}

}  // namespace flatlight
