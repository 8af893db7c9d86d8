// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_BACKUP_H_
#define FLATLIGHT_SERVER_STORE_BACKUP_H_

#include <functional>
#include <string>

#include "absl/status/status.h"

namespace flatlight {

// Copies the folder of a server, which may be running, to a new folder of the same form: all as it was at one moment.
// Files never change, so a copy of the database and of all files that it names is such a moment. Files may go between
// the two, as checkpoints are replaced and jobs deleted; then the database is copied anew, and only what is new after
// it. `database_copied` is called after each time: for tests.
absl::Status BackUp(const std::string& folder, const std::string& backup,
                    const std::function<void()>& database_copied = nullptr);

// Makes a new folder for a server from a backup, whose every byte is checked. DATA_LOSS if it is damaged.
absl::Status RestoreBackup(const std::string& backup, const std::string& folder);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_BACKUP_H_
