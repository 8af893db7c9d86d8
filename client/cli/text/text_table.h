// SPDX-License-Identifier: Apache-2.0
// Text for a terminal: columns, and lines that fit.
#ifndef FLATLIGHT_CLIENT_CLI_TEXT_TEXT_TABLE_H_
#define FLATLIGHT_CLIENT_CLI_TEXT_TEXT_TABLE_H_

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace flatlight {

// Number of columns that UTF-8 text takes, one a code point.
std::size_t TextWidth(std::string_view text);

// The longest beginning of at most `width` columns; never cuts a code point.
std::string CutToWidth(std::string_view text, std::size_t width);

// Control characters become '?', so that a name from a file or a server cannot steer the terminal.
std::string Printable(std::string_view text);

// Rows with columns aligned to the left and two spaces between; no trailing spaces. Each line ends with a newline.
std::string FormatTable(const std::vector<std::vector<std::string>>& rows, std::string_view indent = "");

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_TEXT_TEXT_TABLE_H_
