// SPDX-License-Identifier: Apache-2.0
// SQLite behind a few calls: owned handles, and absl::Status in place of result codes.
#ifndef FLATLIGHT_SERVER_STORE_DATABASE_H_
#define FLATLIGHT_SERVER_STORE_DATABASE_H_

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

struct sqlite3;
struct sqlite3_stmt;

namespace flatlight {

// One SQL statement with its parameters and, while it is stepped through, its rows.
class Statement {
 public:
  // Parameters are bound in order, each once.
  Statement& Bind(std::int64_t value);
  Statement& Bind(std::string_view text);
  Statement& Bind(const std::optional<std::string>& text);  // Absent: null.
  Statement& BindReal(double value);
  Statement& BindBlob(std::string_view bytes);
  Statement& BindNull();

  // Whether there is a (further) row.
  absl::StatusOr<bool> Step();
  // To before the first row, with the parameters as they are.
  void Reset();
  // To the end, visit(*this) for each row.
  template <class Visit>
  absl::Status ForEachRow(Visit visit) {
    while (true) {
      const absl::StatusOr<bool> row = Step();
      if (!row.ok()) return row.status();
      if (!*row) return absl::OkStatus();
      visit(std::as_const(*this));
    }
  }
  // The same for statements that give no rows.
  absl::Status Run();

  // Of the row, columns from 0.
  std::int64_t Integer(int column) const;
  double Real(int column) const;
  std::string Bytes(int column) const;  // Text or blob.
  std::optional<std::string> OptionalBytes(int column) const;

 private:
  friend class Database;
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  Statement(sqlite3* database, std::string place, const std::string& sql);

  sqlite3* database_;
  std::string place_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  int bound_ = 0;
  absl::Status failure_;  // Of preparing and binding, told by the next step.
};

// One connection. Not to be used by two threads at once.
class Database {
 public:
  // Written ahead and synced at each commit: what was committed outlives the process and the machine's power. Makes the
  // file if it is missing.
  static absl::StatusOr<std::unique_ptr<Database>> Open(const std::string& path);
  static absl::StatusOr<std::unique_ptr<Database>> OpenExisting(const std::string& path);

  Statement Prepare(const std::string& sql) { return {database_.get(), path_, sql}; }
  // One or more statements without parameters.
  absl::Status Execute(const std::string& sql);
  // What connections tell each other through shared memory of what has been committed (the first header of the
  // write-ahead log's index, https://sqlite.org/walformat.html): where it is as it was, SQLite too takes it that
  // nothing was. Costs no system call. Absent where there is no such log.
  using LogHeader = std::array<std::uint32_t, 12>;
  std::optional<LogHeader> ReadLogHeader();
  // By the statement before.
  std::int64_t changed_rows() const;

  // All that has been committed, as a database of its own, while others write to this one.
  absl::Status BackUp(const std::string& path);
  const std::string& path() const { return path_; }

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  static absl::StatusOr<std::unique_ptr<Database>> OpenWith(const std::string& path, int flags);
  Database(sqlite3* database, std::string path) : database_(database), path_(std::move(path)) {}

  std::unique_ptr<sqlite3, Close> database_;
  std::string path_;
};

// What is done until Commit is done as a whole or, without it, not at all.
class Transaction {
 public:
  explicit Transaction(Database& database) : database_(database) {}
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  absl::Status Begin();
  absl::Status Commit();

 private:
  Database& database_;
  bool open_ = false;
};

// UNAVAILABLE, RESOURCE_EXHAUSTED or DATA_LOSS, with the reasons STORAGE_FULL, STORAGE_READ_ONLY, STORAGE_FAILED,
// STORAGE_DAMAGED: what `place` says of an error number of the system, and what to do.
absl::Status StorageError(const std::string& place, int error_number);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_DATABASE_H_
