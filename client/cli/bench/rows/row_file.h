// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_ROWS_ROW_FILE_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_ROWS_ROW_FILE_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/bench/rows/bench_row.h"

namespace flatlight {

// A CSV file that grows by a row at a time, each written whole or not at all. One program at a time has it open.
class RowFile {
 public:
  // Reads the rows that are there. A file that is not there is made by the first Append. Damage is bad usage, with line
  // and column; what cannot be written ends with ExitCode::kOutput.
  static absl::StatusOr<std::unique_ptr<RowFile>> Open(const std::string& path);
  ~RowFile();
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;

  const std::string& path() const { return path_; }
  const std::vector<BenchRow>& rows() const { return rows_; }

  absl::Status Append(const BenchRow& row);

 private:
  explicit RowFile(std::string path) : path_(std::move(path)) {}
  absl::Status OpenDescriptor(int flags);
  absl::Status Write(const std::string& text);

  std::string path_;
  int fd_ = -1;  // -1: the file is not there yet.
  bool empty_ = true;
  std::vector<BenchRow> rows_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_ROWS_ROW_FILE_H_
