// SPDX-License-Identifier: Apache-2.0
#include "server/store/database.h"

#include <sqlite3.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <utility>

#include "server/store/error.h"

namespace flatlight {
namespace {

constexpr int kBusyMilliseconds = 10'000;  // Only backups share a database.

absl::Status DatabaseError(sqlite3* database, const std::string& place) {
  const int last_error = errno;  // Where SQLite has forgotten it.
  const int code = sqlite3_errcode(database) & 0xff;
  const int system = sqlite3_system_errno(database);
  const std::string what = sqlite3_errmsg(database);
  switch (code) {
    case SQLITE_FULL:
      return StorageError(place, ENOSPC);
    case SQLITE_READONLY:
      return StorageError(place, EROFS);
    case SQLITE_CANTOPEN:
    case SQLITE_IOERR:
      if (system != 0 || last_error != 0) return StorageError(place, system != 0 ? system : last_error);
      return MakeError(absl::StatusCode::kUnavailable, "STORAGE_FAILED", "cannot use " + place + ": " + what);
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return MakeError(absl::StatusCode::kDataLoss, "STORAGE_DAMAGED",
                       place + " is damaged (" + what + "); restore the folder from a backup");
    default:
      return MakeError(absl::StatusCode::kUnavailable, "STORAGE_FAILED", "cannot use " + place + ": " + what);
  }
}

}  // namespace

absl::Status StorageError(const std::string& place, int error_number) {
  const std::string why = std::strerror(error_number);
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return MakeError(absl::StatusCode::kResourceExhausted, "STORAGE_FULL",
                       "no room to write " + place + " (" + why + "); free some space, then try again");
    case EROFS:
    case EACCES:
    case EPERM:
      return MakeError(absl::StatusCode::kUnavailable, "STORAGE_READ_ONLY",
                       "may not write " + place + " (" + why + "); let the server's user write there, then try again");
    default:
      return MakeError(absl::StatusCode::kUnavailable, "STORAGE_FAILED", "cannot use " + place + ": " + why);
  }
}

void Statement::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

Statement::Statement(sqlite3* database, std::string place, const std::string& sql)
    : database_(database), place_(std::move(place)) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database, sql.c_str(), -1, &statement, nullptr) != SQLITE_OK) {
    failure_ = DatabaseError(database, place_);
  }
  statement_.reset(statement);
}

Statement& Statement::Bind(std::int64_t value) {
  sqlite3_bind_int64(statement_.get(), ++bound_, value);
  return *this;
}

Statement& Statement::Bind(std::string_view text) {
  sqlite3_bind_text64(statement_.get(), ++bound_, text.data(), text.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
  return *this;
}

Statement& Statement::Bind(const std::optional<std::string>& text) {
  return text ? Bind(std::string_view(*text)) : BindNull();
}

Statement& Statement::BindReal(double value) {
  sqlite3_bind_double(statement_.get(), ++bound_, value);
  return *this;
}

Statement& Statement::BindBlob(std::string_view bytes) {
  // Of no bytes, a null pointer would mean null.
  const char* data = bytes.empty() ? "" : bytes.data();
  sqlite3_bind_blob64(statement_.get(), ++bound_, data, bytes.size(), SQLITE_TRANSIENT);
  return *this;
}

Statement& Statement::BindNull() {
  sqlite3_bind_null(statement_.get(), ++bound_);
  return *this;
}

absl::StatusOr<bool> Statement::Step() {
  if (!failure_.ok()) return failure_;
  errno = 0;
  switch (sqlite3_step(statement_.get())) {
    case SQLITE_ROW:
      return true;
    case SQLITE_DONE:
      return false;
    default:
      return DatabaseError(database_, place_);
  }
}

void Statement::Reset() { sqlite3_reset(statement_.get()); }

absl::Status Statement::Run() {
  return ForEachRow([](const Statement&) {});
}

std::int64_t Statement::Integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }

double Statement::Real(int column) const { return sqlite3_column_double(statement_.get(), column); }

std::string Statement::Bytes(int column) const {
  const void* data = sqlite3_column_blob(statement_.get(), column);
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
  return data == nullptr ? std::string() : std::string(static_cast<const char*>(data), size);
}

std::optional<std::string> Statement::OptionalBytes(int column) const {
  if (sqlite3_column_type(statement_.get(), column) == SQLITE_NULL) return std::nullopt;
  return Bytes(column);
}

void Database::Close::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

absl::StatusOr<std::unique_ptr<Database>> Database::OpenWith(const std::string& path, int flags) {
  sqlite3* handle = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &handle, flags | SQLITE_OPEN_EXRESCODE, nullptr);
  std::unique_ptr<Database> database(new Database(handle, path));
  if (code != SQLITE_OK) return DatabaseError(handle, path);
  sqlite3_busy_timeout(handle, kBusyMilliseconds);
  return database;
}

absl::StatusOr<std::unique_ptr<Database>> Database::Open(const std::string& path) {
  auto database = OpenWith(path, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  if (!database.ok()) return database;
  const absl::Status set =
      (*database)->Execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON");
  if (!set.ok()) return set;
  return database;
}

absl::StatusOr<std::unique_ptr<Database>> Database::OpenExisting(const std::string& path) {
  return OpenWith(path, SQLITE_OPEN_READWRITE);
}

absl::Status Database::Execute(const std::string& sql) {
  errno = 0;
  if (sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK) return absl::OkStatus();
  return DatabaseError(database_.get(), path_);
}

std::optional<Database::LogHeader> Database::ReadLogHeader() {
  constexpr int kRegionBytes = 32 << 10;  // As SQLite maps it.
  sqlite3_file* file = nullptr;
  if (sqlite3_file_control(database_.get(), "main", SQLITE_FCNTL_FILE_POINTER, &file) != SQLITE_OK || file == nullptr ||
      file->pMethods == nullptr || file->pMethods->iVersion < 2) {
    return std::nullopt;
  }
  void volatile* region = nullptr;
  if (file->pMethods->xShmMap(file, 0, kRegionBytes, 0, &region) != SQLITE_OK || region == nullptr) return std::nullopt;
  // Others may be writing it: what is torn equals neither what was nor what will be.
  auto* words = const_cast<std::uint32_t*>(static_cast<std::uint32_t volatile*>(region));
  LogHeader header;
  for (std::size_t i = 0; i < header.size(); ++i) header[i] = std::atomic_ref(words[i]).load(std::memory_order_acquire);
  return header;
}

std::int64_t Database::changed_rows() const { return sqlite3_changes64(database_.get()); }

absl::Status Database::BackUp(const std::string& path) {
  const auto copy = OpenWith(path, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  if (!copy.ok()) return copy.status();
  sqlite3* target = (*copy)->database_.get();
  sqlite3_backup* backup = sqlite3_backup_init(target, "main", database_.get(), "main");
  if (backup == nullptr) return DatabaseError(target, path);
  // In one step: in several, every write in between would begin the copy anew.
  const int code = sqlite3_backup_step(backup, -1);
  sqlite3_backup_finish(backup);
  if (code != SQLITE_DONE) return DatabaseError(target, path);
  // One file, without a log beside it.
  return (*copy)->Execute("PRAGMA journal_mode = DELETE");
}

Transaction::~Transaction() {
  // SQLite may have rolled back by itself.
  if (open_) database_.Execute("ROLLBACK").IgnoreError();
}

absl::Status Transaction::Begin() {
  absl::Status begun = database_.Execute("BEGIN IMMEDIATE");
  open_ = begun.ok();
  return begun;
}

absl::Status Transaction::Commit() {
  absl::Status committed = database_.Execute("COMMIT");
  if (committed.ok()) open_ = false;
  return committed;
}

}  // namespace flatlight
