// SPDX-License-Identifier: Apache-2.0
// What was measured, as CSV for programs and as a table for people.
#ifndef FLATLIGHT_TESTS_BENCH_PEERS_REPORT_H_
#define FLATLIGHT_TESTS_BENCH_PEERS_REPORT_H_

#include <cstdio>
#include <string>
#include <vector>

#include "tests/bench/peers/turns.h"

namespace flatlight {

struct Row {
  std::string name;      // Of the program.
  std::string scene;     // What is asked for.
  int size = 0;          // Segments.
  std::string density;   // Rule for their length.
  std::string unit;      // Of the rate.
  Timing timing;         // All 0 if the answers were checked and nothing was timed.
  double differing = 0;  // Share of answers that are not Flatlight's.
};

// The header line too; what was not timed is left empty. False if `file` could not be written.
bool WriteCsv(const std::vector<Row>& rows, std::FILE* file);

// Rates, ratios and the least ratio of each peer.
void PrintTable(const std::vector<Row>& rows, std::FILE* file);

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_BENCH_PEERS_REPORT_H_
