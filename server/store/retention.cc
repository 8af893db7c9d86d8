// SPDX-License-Identifier: Apache-2.0
#include "server/store/retention.h"

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "absl/strings/numbers.h"

namespace flatlight {
namespace {

constexpr std::array<std::string_view, kJobClasses> kNames = {"interactive", "graded", "regrade"};
constexpr std::int64_t kMostSeconds = 86'400LL * 36'500;  // A century: times stay far from where they overflow.

std::int64_t SecondsIn(char unit) {
  switch (unit) {
    case 's':
      return 1;
    case 'm':
      return 60;
    case 'h':
      return 3600;
    case 'd':
      return 86'400;
    default:
      return 0;
  }
}

}  // namespace

absl::Status Retention::Set(const std::string& text) {
  const auto bad = [&](const std::string& what) { return absl::InvalidArgumentError("\"" + text + "\": " + what); };
  const std::size_t equals = text.find('=');
  const auto* name = std::find(kNames.begin(), kNames.end(), text.substr(0, equals));
  if (equals == std::string::npos || name == kNames.end()) {
    return bad("must be CLASS=DURATION, with the class interactive, graded or regrade");
  }
  auto& kept = keep[static_cast<std::size_t>(name - kNames.begin())];
  const std::string value = text.substr(equals + 1);
  if (value == "none") {
    kept.reset();
    return absl::OkStatus();
  }
  std::int64_t number = 0;
  const std::int64_t unit = value.empty() ? 0 : SecondsIn(value.back());
  if (unit == 0 || value.front() < '0' || value.front() > '9' ||
      !absl::SimpleAtoi(value.substr(0, value.size() - 1), &number) || number < 1 || number > kMostSeconds / unit) {
    return bad("the duration must be none, or a whole number with s, m, h or d, from 1s to 36500d");
  }
  kept = std::chrono::seconds(number * unit);
  return absl::OkStatus();
}

}  // namespace flatlight
