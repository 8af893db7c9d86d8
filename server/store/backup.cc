// SPDX-License-Identifier: Apache-2.0
#include "server/store/backup.h"

#include <filesystem>
#include <set>
#include <vector>

#include "server/store/blob_files.h"
#include "server/store/database.h"
#include "server/store/error.h"
#include "server/store/schema.h"
#include "server/store/sha256.h"
#include "server/store/storage.h"

namespace flatlight {
namespace {

namespace fs = std::filesystem;

// A server that replaces files faster than they can be copied is not to keep a backup going for ever.
constexpr int kMostRounds = 20;

absl::Status ExpectDatabase(const std::string& folder) {
  if (fs::exists(Storage::DatabasePath(folder))) return absl::OkStatus();
  return MakeError(absl::StatusCode::kNotFound, "NO_DATA", folder + " is not the folder of a server or of a backup");
}

absl::Status MakeNewFolder(const std::string& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_empty(folder, error)) {
    return MakeError(absl::StatusCode::kAlreadyExists, "FOLDER_NOT_EMPTY",
                     folder + " is there already and not empty; name a new folder");
  }
  if (absl::Status made = MakeFolder(folder); !made.ok()) return made;
  return MakeFolder(Storage::BlobFolder(folder));
}

// The blobs that lie in files; those in the database are checked on the way if `check` is set.
absl::StatusOr<std::vector<std::string>> FilesOf(Database& database, bool check) {
  std::vector<std::string> files;
  Statement blobs = database.Prepare("SELECT sha256, bytes FROM blobs");
  while (true) {
    const auto row = blobs.Step();
    if (!row.ok()) return row.status();
    if (!*row) return files;
    const auto bytes = blobs.OptionalBytes(1);
    if (!bytes) {
      files.push_back(blobs.Bytes(0));
    } else if (check && Sha256Of(*bytes) != blobs.Bytes(0)) {
      return MakeError(absl::StatusCode::kDataLoss, "STORAGE_DAMAGED",
                       database.path() + ": blob " + blobs.Bytes(0) + " is damaged; use another backup");
    }
  }
}

absl::Status CheckDatabase(Database& database) {
  Statement check = database.Prepare("PRAGMA integrity_check");
  const auto row = check.Step();
  if (!row.ok()) return row.status();
  if (*row && check.Bytes(0) == "ok") return absl::OkStatus();
  return MakeError(absl::StatusCode::kDataLoss, "STORAGE_DAMAGED",
                   database.path() + " is damaged: " + check.Bytes(0) + "; use another backup");
}

// Who watched a review room may know of more than the backup does: the next notes have those notes' sequences.
absl::Status RenewEpochs(const std::string& path) {
  const auto database = Database::OpenExisting(path);
  if (!database.ok()) return database.status();
  const auto has_rooms = (*database)->Prepare("SELECT 1 FROM sqlite_master WHERE name = 'rooms'").Step();
  if (!has_rooms.ok() || !*has_rooms) return has_rooms.status();
  // 53 bits, as RoomStore's.
  return (*database)->Execute("UPDATE rooms SET epoch = (random() & 0x1FFFFFFFFFFFFF) | 1");
}

}  // namespace

absl::Status BackUp(const std::string& folder, const std::string& backup,
                    const std::function<void()>& database_copied) {
  if (absl::Status there = ExpectDatabase(folder); !there.ok()) return there;
  if (absl::Status made = MakeNewFolder(backup); !made.ok()) return made;
  const auto live = Database::OpenExisting(Storage::DatabasePath(folder));
  if (!live.ok()) return live.status();
  const BlobFiles source(Storage::BlobFolder(folder));
  BlobFiles target(Storage::BlobFolder(backup));
  // Under another name until it is whole: what has no database is no backup.
  const std::string copy_path = Storage::DatabasePath(backup) + ".part";
  absl::Status missing;
  for (int round = 0; round < kMostRounds; ++round) {
    fs::remove(copy_path);
    if (absl::Status copied = (*live)->BackUp(copy_path); !copied.ok()) return copied;
    if (database_copied) database_copied();
    std::set<std::string> named;
    {
      const auto copy = Database::OpenExisting(copy_path);
      if (!copy.ok()) return copy.status();
      const auto files = FilesOf(**copy, false);
      if (!files.ok()) return files.status();
      named.insert(files->begin(), files->end());
    }
    missing = absl::OkStatus();
    for (const std::string& sha256 : named) {
      if (fs::exists(target.PathOf(sha256))) continue;
      const auto bytes = source.Read(sha256);
      if (!bytes.ok()) {
        missing = bytes.status();
        continue;
      }
      if (absl::Status written = target.Write(sha256, *bytes); !written.ok()) return written;
    }
    if (!missing.ok()) continue;
    target.Sweep([&](const std::string& sha256) { return named.count(sha256) > 0; });
    std::error_code error;
    fs::rename(copy_path, Storage::DatabasePath(backup), error);
    if (error) return StorageError(Storage::DatabasePath(backup), error.value());
    return SyncFolder(backup);
  }
  return missing;
}

absl::Status RestoreBackup(const std::string& backup, const std::string& folder) {
  if (absl::Status there = ExpectDatabase(backup); !there.ok()) return there;
  if (absl::Status made = MakeNewFolder(folder); !made.ok()) return made;
  const auto database = Database::OpenExisting(Storage::DatabasePath(backup));
  if (!database.ok()) return database.status();
  if (absl::Status whole = CheckDatabase(**database); !whole.ok()) return whole;
  const auto files = FilesOf(**database, true);
  if (!files.ok()) return files.status();
  const BlobFiles source(Storage::BlobFolder(backup));
  BlobFiles target(Storage::BlobFolder(folder));
  for (const std::string& sha256 : *files) {
    const auto bytes = source.Read(sha256);
    if (!bytes.ok()) return bytes.status();
    if (absl::Status written = target.Write(sha256, *bytes); !written.ok()) return written;
  }
  const std::string copy_path = Storage::DatabasePath(folder) + ".part";
  if (absl::Status copied = (*database)->BackUp(copy_path); !copied.ok()) return copied;
  if (absl::Status renewed = RenewEpochs(copy_path); !renewed.ok()) return renewed;
  // Last: what has no database is no folder of a server.
  std::error_code error;
  fs::rename(copy_path, Storage::DatabasePath(folder), error);
  if (error) return StorageError(Storage::DatabasePath(folder), error.value());
  return SyncFolder(folder);
}

}  // namespace flatlight
