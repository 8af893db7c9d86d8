// SPDX-License-Identifier: Apache-2.0
// What benchmark programs that write tables have in common: where they ran, how they time, what they print.
#ifndef FLATLIGHT_TESTS_BENCH_BENCH_REPORT_H_
#define FLATLIGHT_TESTS_BENCH_BENCH_REPORT_H_

#include <fstream>
#include <string>
#include <vector>

namespace flatlight {

// Of the calling thread, s.
double ThreadSeconds();

struct Quartiles {
  double lower = 0;
  double median = 0;
  double upper = 0;
};
// Of at least one value.
Quartiles QuartilesOf(std::vector<double> values);

std::string MachineName();  // The processor's.
// Release and commit that this program was configured at, and the beginning of its own SHA-256: an edited tree has
// builds without number of one commit. "0.1.0+1bcd874a90e2 (5e8e3a12)".
std::string BuildName();

// Three significant digits.
std::string Short(double value);

// A table whose columns are as wide as they need, and the same rows as CSV with machine and build in front.
class BenchTable {
 public:
  explicit BenchTable(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  void Add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  void Print() const;
  // Makes the folder if there is none. False if the file could not be written.
  bool WriteCsv(const std::string& path) const;
  // Both. False, and it says so, if the file could not be written.
  bool Report(const std::string& path) const;

 private:
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_BENCH_BENCH_REPORT_H_
