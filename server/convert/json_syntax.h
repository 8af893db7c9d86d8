// SPDX-License-Identifier: Apache-2.0
// What is wrong with a text that is not JSON, in words for the person who wrote it.
#ifndef FLATLIGHT_SERVER_CONVERT_JSON_SYNTAX_H_
#define FLATLIGHT_SERVER_CONVERT_JSON_SYNTAX_H_

#include <string>
#include <string_view>
#include <vector>

#include "core/scene/diagnostic.h"
#include "server/convert/json_message_reader.h"

namespace flatlight {

// The path is "line L, column C", both counted from 1, the column in characters. `near`: the path of the value
// that was read last, or is being read; empty if there is none.
Diagnostic DescribeSyntaxError(std::string_view text, const JsonSyntaxError& error, const std::string& near);

// The same for a text that is whole but for the NUL at its end.
Diagnostic DescribeNul(std::string_view text);

// True if the parser stopped at a number that it cannot hand on: one that no double can hold, NaN or an infinity.
bool IsAboutUnusableNumber(std::string_view text, const JsonSyntaxError& error);

// Blanks out every such number with a 0 of the same length and returns them, so that a reader can go on past them and
// name their paths. Text inside strings is left alone.
std::vector<UnusableNumber> BlankUnusableNumbers(std::string& text);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_CONVERT_JSON_SYNTAX_H_
