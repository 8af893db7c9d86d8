// SPDX-License-Identifier: Apache-2.0
// The columns of the CSV file of a benchmark: what each is called, how it is written and read.
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_ROWS_ROW_COLUMNS_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_ROWS_ROW_COLUMNS_H_

#include <functional>
#include <string>
#include <vector>

#include "client/cli/bench/rows/bench_row.h"

namespace flatlight {

struct RowColumn {
  std::string name;
  std::function<std::string(const BenchRow&)> write;
  // Sets the row's value from a text. False, and the row is of no use, if the text is not `allowed`.
  std::function<bool(BenchRow&, const std::string&)> read;
  std::string allowed;  // "a number from 0".
};

// In the order of the file.
const std::vector<RowColumn>& RowColumns();

// The first line of the file, with its line break.
std::string RowHeader();

// A line, with its line break.
std::string RowText(const BenchRow& row);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_ROWS_ROW_COLUMNS_H_
