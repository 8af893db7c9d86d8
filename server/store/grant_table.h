// SPDX-License-Identifier: Apache-2.0
// Grants in a database. A resource is named as callers name it: "jobs/{uuid}"; or, of several owners, below that:
// "scenes/{sha256}/owners/{owner}".
#ifndef FLATLIGHT_SERVER_STORE_GRANT_TABLE_H_
#define FLATLIGHT_SERVER_STORE_GRANT_TABLE_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/store/database.h"
#include "server/store/grants.h"

namespace flatlight {

absl::StatusOr<std::vector<Grant>> ReadGrants(Database& database, const std::string& resource);
// In a transaction: as AddGrant and RemoveGrant.
absl::Status InsertGrant(Database& database, const std::string& resource, const Grant& grant);
absl::Status DeleteGrant(Database& database, const std::string& resource, const Grantee& grantee);

// In SQL: the resources that are granted to one who is all of `who`, with places for BindGrantees.
std::string ResourcesOf(const std::vector<Grantee>& who);
void BindGrantees(const std::vector<Grantee>& who, Statement& statement);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_GRANT_TABLE_H_
