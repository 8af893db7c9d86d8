// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_ROWS_ROW_READER_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_ROWS_ROW_READER_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/bench/rows/bench_row.h"

namespace flatlight {

// The rows of a benchmark's CSV file; its columns are told by the first line and may be in any order. Errors are bad
// usage with a line for each mistake (of many the first ones): "bench.csv: line 3, column 17: rays is 'x'; must be a
// number from 0".
absl::StatusOr<std::vector<BenchRow>> RowsFromCsv(const std::string& bytes, const std::string& label);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_ROWS_ROW_READER_H_
