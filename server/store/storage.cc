// SPDX-License-Identifier: Apache-2.0
#include "server/store/storage.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "server/store/error.h"
#include "server/store/schema.h"
#include "server/store/sha256.h"

namespace flatlight {
namespace {

absl::StatusOr<int> LockFolder(const std::string& folder) {
  const std::string path = folder + "/lock";
  const int fd = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (fd < 0) return StorageError(path, errno);
  if (flock(fd, LOCK_EX | LOCK_NB) == 0) return fd;
  close(fd);
  return MakeError(absl::StatusCode::kUnavailable, "STORAGE_IN_USE",
                   "another server uses " + folder + "; end it first, or give this one a folder of its own");
}

absl::StatusOr<bool> IsUsed(Database& database, const std::string& sha256) {
  return database.Prepare("SELECT 1 FROM blobs WHERE sha256 = ?").Bind(std::string_view(sha256)).Step();
}

}  // namespace

absl::StatusOr<std::unique_ptr<Storage>> Storage::Open(const std::string& folder) {
  if (absl::Status made = MakeFolder(folder); !made.ok()) return made;
  const auto lock = LockFolder(folder);
  if (!lock.ok()) return lock.status();
  std::unique_ptr<Storage> storage(new Storage(folder, *lock));
  auto database = Database::Open(DatabasePath(folder));
  if (!database.ok()) return database.status();
  const std::lock_guard guard(storage->mutex_);
  storage->database_ = *std::move(database);
  if (absl::Status migrated = Migrate(storage->database()); !migrated.ok()) return migrated;
  if (absl::Status made = MakeFolder(BlobFolder(folder)); !made.ok()) return made;
  if (absl::Status synced = SyncFolder(folder); !synced.ok()) return synced;
  storage->files_.Sweep([&](const std::string& sha256) {
    const auto used = IsUsed(storage->database(), sha256);
    return !used.ok() || *used;
  });
  return storage;
}

Storage::~Storage() {
  database_.reset();
  close(lock_fd_);
}

absl::Status Storage::Writing::Use(const Blob& blob) {
  touched_.push_back(blob.sha256);
  const bool in_line = blob.bytes->size() <= kMostInlineBytes;
  if (!in_line) {
    // It is there, unless the last use of the same bytes has just ended.
    if (absl::Status written = storage_.files_.Write(blob.sha256, *blob.bytes); !written.ok()) return written;
  }
  Statement use = Prepare(
      "INSERT INTO blobs(sha256, bytes, uses) VALUES(?, ?, 1) ON CONFLICT(sha256) DO UPDATE SET uses = uses + 1");
  use.Bind(std::string_view(blob.sha256));
  return (in_line ? use.BindBlob(*blob.bytes) : use.BindNull()).Run();
}

absl::Status Storage::Writing::Rewrite(const Blob& blob) {
  if (blob.bytes->size() > kMostInlineBytes) return absl::OkStatus();  // Prepare has done so.
  return Prepare("UPDATE blobs SET bytes = ? WHERE sha256 = ?")
      .BindBlob(*blob.bytes)
      .Bind(std::string_view(blob.sha256))
      .Run();
}

absl::Status Storage::Writing::Release(const std::optional<std::string>& sha256) {
  if (!sha256) return absl::OkStatus();
  touched_.push_back(*sha256);
  absl::Status less =
      Prepare("UPDATE blobs SET uses = uses - 1 WHERE sha256 = ?").Bind(std::string_view(*sha256)).Run();
  if (!less.ok()) return less;
  return Prepare("DELETE FROM blobs WHERE sha256 = ? AND uses = 0").Bind(std::string_view(*sha256)).Run();
}

absl::Status Storage::Write(const std::function<absl::Status(Writing&)>& work) {
  const std::lock_guard lock(mutex_);
  Writing writing(*this);
  absl::Status done;
  {
    Transaction transaction(database());
    done = transaction.Begin();
    if (done.ok()) done = work(writing);
    if (done.ok()) done = transaction.Commit();
  }
  RemoveUnused(writing.touched_);
  return done;
}

void Storage::RemoveUnused(const std::vector<std::string>& touched) {
  for (const std::string& sha256 : touched) {
    const auto used = IsUsed(database(), sha256);
    if (used.ok() && !*used) files_.Remove(sha256);
  }
}

absl::Status Storage::Read(const std::function<absl::Status(Database&)>& work) {
  const std::lock_guard lock(mutex_);
  return work(database());
}

absl::StatusOr<Blob> Storage::Prepare(std::string bytes) {
  auto shared = std::make_shared<const std::string>(std::move(bytes));
  std::string sha256 = Sha256Of(*shared);
  return Prepare(std::move(sha256), std::move(shared));
}

absl::StatusOr<Blob> Storage::Prepare(std::string sha256, std::shared_ptr<const std::string> bytes,
                                      BlobFiles::IfThere if_there) {
  Blob blob{std::move(sha256), std::move(bytes)};
  if (blob.bytes->size() > kMostInlineBytes) {
    if (absl::Status written = files_.Write(blob.sha256, *blob.bytes, if_there); !written.ok()) return written;
  }
  return blob;
}

std::uint64_t Storage::SizeOf(const std::string& sha256) {
  std::optional<std::int64_t> in_line;
  const absl::Status read = Read([&](Database& database) -> absl::Status {
    Statement blob = database.Prepare("SELECT length(bytes) FROM blobs WHERE sha256 = ? AND bytes IS NOT NULL");
    const auto row = blob.Bind(std::string_view(sha256)).Step();
    if (row.ok() && *row) in_line = blob.Integer(0);
    return row.status();
  });
  if (!read.ok()) return 0;
  if (in_line) return static_cast<std::uint64_t>(*in_line);
  struct stat file {};
  return stat(files_.PathOf(sha256).c_str(), &file) == 0 ? static_cast<std::uint64_t>(file.st_size) : 0;
}

absl::StatusOr<std::string> Storage::Fetch(const std::string& sha256) {
  std::optional<std::string> bytes;
  const absl::Status read = Read([&](Database& database) -> absl::Status {
    Statement blob = database.Prepare("SELECT bytes FROM blobs WHERE sha256 = ?");
    blob.Bind(std::string_view(sha256));
    const auto row = blob.Step();
    if (!row.ok()) return row.status();
    if (!*row) return MakeError(absl::StatusCode::kDataLoss, "STORAGE_DAMAGED", "blob " + sha256 + " is missing");
    bytes = blob.OptionalBytes(0);
    return absl::OkStatus();
  });
  if (!read.ok()) return read;
  if (!bytes) return files_.Read(sha256);
  if (Sha256Of(*bytes) == sha256) return *std::move(bytes);
  return MakeError(absl::StatusCode::kDataLoss, "STORAGE_DAMAGED",
                   "blob " + sha256 + " in " + DatabasePath(folder_) + " is damaged; restore it from a backup");
}

}  // namespace flatlight
