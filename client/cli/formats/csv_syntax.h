// SPDX-License-Identifier: Apache-2.0
// Comma-separated values (RFC 4180), with the place of every value.
#ifndef FLATLIGHT_CLIENT_CLI_FORMATS_CSV_SYNTAX_H_
#define FLATLIGHT_CLIENT_CLI_FORMATS_CSV_SYNTAX_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace flatlight {

struct CsvField {
  std::string text;
  int line = 1;    // From 1.
  int column = 1;  // In bytes, from 1.
};

// "line 3, column 17".
std::string PlaceOf(const CsvField& field);

// Every row ends with a line break (LF or CRLF). Errors are bad usage and name `label`, line and column.
absl::StatusOr<std::vector<std::vector<CsvField>>> ParseCsv(const std::string& bytes, const std::string& label);

// In quotes if it needs them.
std::string CsvText(const std::string& text);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_FORMATS_CSV_SYNTAX_H_
