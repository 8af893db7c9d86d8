// SPDX-License-Identifier: Apache-2.0
// Numbers for people.
#ifndef FLATLIGHT_CLIENT_CLI_TEXT_NUMBERS_H_
#define FLATLIGHT_CLIENT_CLI_TEXT_NUMBERS_H_

#include <string>

namespace flatlight {

// Three significant digits and an SI prefix for values from 1000 up: 12.4 M, 950, 0.
std::string FormatCount(double value);

// `digits` significant digits, scientific where that is shorter: 0.1533, 3.2e-14.
std::string FormatValue(double value, int digits = 4);

// So many digits after the point: -0.50.
std::string FormatFixed(double value, int decimals);

// Two significant digits: 1.3 %, 0.042 %, 120 %.
std::string FormatPercent(double fraction);

// 0.35 s, 12 s, 3:05, 2:03:05.
std::string FormatSeconds(double seconds);

// 512 bytes, 1.5 MiB.
std::string FormatBytes(double bytes);

// The shortest text that reads back as the same double.
std::string FormatExactly(double value);

// "1 probe", "3 probes".
std::string Plural(double count, const std::string& noun);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_TEXT_NUMBERS_H_
