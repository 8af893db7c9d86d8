// SPDX-License-Identifier: Apache-2.0
#include "server/quota/quotas.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

#include "server/store/error.h"

namespace flatlight {
namespace {

constexpr double kMebibyte = 1u << 20;
constexpr std::string_view kNone = "none";

struct Limit {
  std::string_view name;
  bool whole;
  double most;
  void (*set)(Quotas& quotas, std::optional<double> value);
};

template <class Number>
std::optional<Number> As(std::optional<double> value, double unit = 1) {
  if (!value) return std::nullopt;
  return static_cast<Number>(*value * unit);
}

constexpr double kMostCount = std::numeric_limits<std::uint32_t>::max();
constexpr std::array<Limit, 5> kLimits = {{
    {"jobs", true, kMostCount, [](Quotas& q, std::optional<double> v) { q.jobs = As<std::uint32_t>(v); }},
    {"cpu-seconds", false, 1e9, [](Quotas& q, std::optional<double> v) { q.cpu_seconds = v; }},
    {"watches", true, kMostCount, [](Quotas& q, std::optional<double> v) { q.watches = As<std::uint32_t>(v); }},
    {"storage-mib", true, 1e9,
     [](Quotas& q, std::optional<double> v) { q.storage_bytes = As<std::uint64_t>(v, kMebibyte); }},
    {"requests", false, 1e6, [](Quotas& q, std::optional<double> v) { q.requests = v; }},
}};

std::string Join(const auto& names) {
  std::string all;
  for (const auto& name : names) all += (all.empty() ? "" : ", ") + std::string(name);
  return all;
}

absl::Status Bad(std::string_view text, const std::string& what) {
  return MakeError(absl::StatusCode::kInvalidArgument, "QUOTA_INVALID",
                   "the quota \"" + std::string(text) + "\": " + what);
}

}  // namespace

std::string QuotaNames() {
  std::array<std::string_view, kLimits.size()> names;
  for (std::size_t i = 0; i < kLimits.size(); ++i) names[i] = kLimits[i].name;
  return Join(names);
}

// A class of 200 on a machine of 64 processors: two hours a day each are a quarter of what it has. Graders submit for
// all of the class at once.
QuotaTable::QuotaTable() {
  constexpr std::uint64_t kGibibyte = 1u << 30;
  quotas_[static_cast<std::size_t>(Role::kStudent)] = {
      .jobs = 100, .cpu_seconds = 7200, .watches = 8, .storage_bytes = kGibibyte / 2, .requests = 50};
  quotas_[static_cast<std::size_t>(Role::kGrader)] = {
      .jobs = 5000, .watches = 100, .storage_bytes = 20 * kGibibyte, .requests = 500};
  quotas_[static_cast<std::size_t>(Role::kInstructor)] = {
      .jobs = 1000, .watches = 100, .storage_bytes = 20 * kGibibyte, .requests = 200};
}

absl::Status QuotaTable::Set(std::string_view text) {
  const std::size_t dot = text.find('.');
  const std::size_t equals = text.find('=');
  if (dot == std::string_view::npos || equals == std::string_view::npos || equals < dot) {
    return Bad(text, "must be ROLE.LIMIT=VALUE, such as student.jobs=50");
  }
  const auto role = RoleOf(text.substr(0, dot));
  if (!role) {
    return Bad(text, "there is no role \"" + std::string(text.substr(0, dot)) + "\"; allowed: " + Join(RoleNames()));
  }
  const std::string_view name = text.substr(dot + 1, equals - dot - 1);
  const std::string_view value = text.substr(equals + 1);
  for (const Limit& limit : kLimits) {
    if (limit.name != name) continue;
    Quotas& quotas = quotas_[static_cast<std::size_t>(*role)];
    if (value == kNone) {
      limit.set(quotas, std::nullopt);
      return absl::OkStatus();
    }
    double number = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    const bool good = error == std::errc() && end == value.data() + value.size() && number > 0 &&
                      number <= limit.most && (!limit.whole || number == std::floor(number));
    if (!good) {
      return Bad(text, "the value \"" + std::string(value) + "\" must be none, or a " +
                           (limit.whole ? "whole number" : "number") + " greater than 0, at most " +
                           std::to_string(static_cast<std::uint64_t>(limit.most)));
    }
    limit.set(quotas, number);
    return absl::OkStatus();
  }
  return Bad(text, "there is no limit \"" + std::string(name) + "\"; allowed: " + QuotaNames());
}

}  // namespace flatlight
