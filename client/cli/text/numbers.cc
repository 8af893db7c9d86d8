// SPDX-License-Identifier: Apache-2.0
#include "client/cli/text/numbers.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace flatlight {
namespace {

std::string Print(const char* format, int digits, double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, digits, value);
  return text.data();
}

// `digits` significant digits without an exponent, for values from 1e-4 to 1e6 or so.
std::string Plain(double value, int digits) {
  const std::string scientific = Print("%.*e", digits - 1, value);  // Rounding may have made it a digit longer.
  const int magnitude = std::atoi(scientific.c_str() + scientific.find('e') + 1);
  return Print("%.*f", std::max(0, digits - 1 - magnitude), value);
}

}  // namespace

std::string FormatCount(double value) {
  constexpr std::array<const char*, 7> kPrefixes = {"", " k", " M", " G", " T", " P", " E"};
  std::size_t prefix = 0;
  while (std::abs(value) >= 999.5 && prefix + 1 < kPrefixes.size()) {
    value /= 1000;
    ++prefix;
  }
  const bool whole = prefix == 0 && value == std::floor(value);
  return (whole ? Print("%.*f", 0, value) : Plain(value, 3)) + kPrefixes[prefix];
}

std::string FormatValue(double value, int digits) { return Print("%.*g", digits, value); }

std::string FormatFixed(double value, int decimals) { return Print("%.*f", decimals, value); }

std::string FormatPercent(double fraction) {
  const double percent = 100 * fraction;
  if (percent == 0) return "0 %";
  if (std::abs(percent) < 1e-4 || std::abs(percent) >= 1e6) return FormatValue(percent, 2) + " %";
  return Plain(percent, 2) + " %";
}

std::string FormatSeconds(double seconds) {
  if (seconds <= 0) return "0 s";
  if (seconds < 0.0009995) return Plain(seconds * 1e6, 2) + " us";
  if (seconds < 0.9995) return Plain(seconds * 1e3, 2) + " ms";
  if (seconds < 9.95) return Plain(seconds, 2) + " s";
  if (seconds < 59.5) return Print("%.*f s", 0, seconds);
  if (seconds > 1e9) return FormatValue(seconds, 2) + " s";
  const auto whole = std::llround(seconds);
  std::array<char, 64> text{};
  if (whole < 3600) {
    std::snprintf(text.data(), text.size(), "%lld:%02lld", whole / 60, whole % 60);
  } else {
    std::snprintf(text.data(), text.size(), "%lld:%02lld:%02lld", whole / 3600, whole / 60 % 60, whole % 60);
  }
  return text.data();
}

std::string FormatBytes(double bytes) {
  constexpr std::array<const char*, 4> kUnits = {" KiB", " MiB", " GiB", " TiB"};
  if (bytes < 1024) return Plural(bytes, "byte");
  std::size_t unit = 0;
  bytes /= 1024;
  while (bytes >= 1024 && unit + 1 < kUnits.size()) {
    bytes /= 1024;
    ++unit;
  }
  return (bytes == std::floor(bytes) ? Print("%.*f", 0, bytes) : Plain(bytes, 3)) + kUnits[unit];
}

std::string FormatExactly(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string Plural(double count, const std::string& noun) {
  return Print("%.*f ", 0, count) + noun + (count == 1 ? "" : "s");
}

}  // namespace flatlight
