// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_SCHEMA_H_
#define FLATLIGHT_SERVER_STORE_SCHEMA_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/store/database.h"

namespace flatlight {

// Entry i makes a database of version i + 1 from one of version i. Released entries never change.
const std::vector<std::string>& Migrations();

// Brings a database to the newest version, each step whole or not at all. FAILED_PRECONDITION if a later Flatlight made
// it. `newest`: for tests.
absl::Status Migrate(Database& database, std::size_t newest = Migrations().size());

// Of the newest version, for what ends with the process.
absl::StatusOr<std::unique_ptr<Database>> NewMemoryDatabase();

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_SCHEMA_H_
