// SPDX-License-Identifier: Apache-2.0
#include "client/cli/options/settings_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "client/cli/formats/enum_names.h"
#include "client/cli/status/exit_code.h"
#include "client/cli/text/numbers.h"

namespace flatlight {
namespace {

using Text = std::optional<std::string>;

absl::Status Refuse(const std::string& option, const std::string& text, const std::string& allowed) {
  return UsageError(option + ": '" + text + "'; must be " + allowed);
}

template <class Number>
bool ParseWhole(const std::string& text, Number& number) {
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && rest == end && !text.empty();
}

// Sets a field by a pointer to its setter.
absl::Status SetCount(const std::string& option, const Text& text, std::uint32_t low, v1::Settings& settings,
                      void (v1::Settings::*set)(std::uint32_t)) {
  if (!text) return absl::OkStatus();
  std::uint32_t value = 0;
  if (!ParseWhole(*text, value) || value < low)
    return Refuse(option, *text,
                  "a whole number from " + std::to_string(low) + " to " +
                      std::to_string(std::numeric_limits<std::uint32_t>::max()));
  (settings.*set)(value);
  return absl::OkStatus();
}

absl::Status SetNumber(const std::string& option, const Text& text, double high, v1::Settings& settings,
                       void (v1::Settings::*set)(double)) {
  if (!text) return absl::OkStatus();
  const absl::StatusOr<double> value = ParseNumber(option, *text, Zero::kRefused, high);
  if (!value.ok()) return value.status();
  (settings.*set)(*value);
  return absl::OkStatus();
}

absl::Status SetSwitch(const std::string& option, const Text& text, v1::Settings& settings,
                       void (v1::Settings::*set)(bool)) {
  if (!text) return absl::OkStatus();
  if (*text != "true" && *text != "false") return Refuse(option, *text, "true or false");
  (settings.*set)(*text == "true");
  return absl::OkStatus();
}

template <class Enum>
absl::Status SetChoice(const std::string& option, const Text& text, v1::Settings& settings,
                       void (v1::Settings::*set)(Enum)) {
  if (!text) return absl::OkStatus();
  const auto& type = *google::protobuf::GetEnumDescriptor<Enum>();
  if (const std::optional<int> value = OptionValue(type, *text)) {
    (settings.*set)(static_cast<Enum>(*value));
    return absl::OkStatus();
  }
  std::string allowed;
  for (const std::string& name : OptionNames(type)) allowed += (allowed.empty() ? "" : ", ") + name;
  return Refuse(option, *text, "one of " + allowed);
}

}  // namespace

absl::StatusOr<double> ParseNumber(const std::string& option, const std::string& text, Zero zero, double high) {
  double value = 0;
  const bool parsed = ParseWhole(text, value) && std::isfinite(value);
  if (parsed && value <= high && (value > 0 || (zero == Zero::kAllowed && value == 0))) return value;
  const std::string low = zero == Zero::kAllowed ? " from 0" : " above 0";
  const bool bounded = high < std::numeric_limits<double>::max();
  return Refuse(option, text, "a number" + low + (bounded ? ", at most " + FormatValue(high) : ""));
}

absl::StatusOr<double> ParseAge(const std::string& option, const std::string& text) {
  constexpr double kMost = 1e9;  // s: 30 years.
  constexpr std::pair<char, double> kUnits[] = {{'s', 1}, {'m', 60}, {'h', 3600}, {'d', 86400}};
  double number = 0;
  if (text == "0") return 0;
  for (const auto& [unit, seconds] : kUnits) {
    if (text.empty() || text.back() != unit || !ParseWhole(text.substr(0, text.size() - 1), number)) continue;
    if (number >= 0 && number * seconds <= kMost) return number * seconds;
  }
  return Refuse(option, text, "0, or a number with its unit: 30s, 90m, 12h, 30d");
}

absl::StatusOr<v1::Probe> ParsePicture(const std::string& text) {
  const std::size_t cross = std::min(text.find('x'), text.size());
  std::uint32_t width = 0, height = 0;
  if (!ParseWhole(text.substr(0, cross), width) || !ParseWhole(text.substr(std::min(cross + 1, text.size())), height) ||
      width == 0 || height == 0) {
    return Refuse("--picture", text, "WIDTHxHEIGHT in pixels, for instance 800x600");
  }
  v1::Probe probe;
  probe.set_name("picture");
  probe.mutable_fluence()->set_width(width);
  probe.mutable_fluence()->set_height(height);
  return probe;
}

absl::StatusOr<v1::Settings> ParseSettings(const SettingsOptions& options) {
  using Settings = v1::Settings;
  constexpr double kAny = std::numeric_limits<double>::max();
  Settings settings;
  const absl::Status results[] = {
      SetChoice("--method", options.method, settings, &Settings::set_method),
      SetCount("--samples", options.samples, 1, settings, &Settings::set_samples),
      SetCount("--max-bounces", options.max_bounces, 0, settings, &Settings::set_max_bounces),
      SetCount("--seed", options.seed, 0, settings, &Settings::set_seed),
      SetChoice("--derivatives", options.derivatives, settings, &Settings::set_derivatives),
      SetChoice("--formulation", options.formulation, settings, &Settings::set_formulation),
      SetChoice("--error-control", options.error_control, settings, &Settings::set_error_control),
      SetChoice("--gather", options.gather, settings, &Settings::set_gather),
      SetCount("--extrapolation", options.extrapolation, 0, settings, &Settings::set_extrapolation),
      SetNumber("--tolerance", options.tolerance, 1, settings, &Settings::set_tolerance),
      SetCount("--max-records", options.max_records, 1, settings, &Settings::set_max_records),
      SetCount("--photons", options.photons, 1, settings, &Settings::set_photons),
      SetSwitch("--final-gather", options.final_gather, settings, &Settings::set_final_gather),
      SetNumber("--bandwidth", options.bandwidth, kAny, settings, &Settings::set_bandwidth),
      SetCount("--neighbours", options.neighbours, 2, settings, &Settings::set_neighbours),
      SetChoice("--kernel", options.kernel, settings, &Settings::set_kernel),
      SetNumber("--target-error", options.target_error, 1, settings, &Settings::set_target_error),
      SetNumber("--time-limit", options.time_limit, kAny, settings, &Settings::set_time_limit),
      SetCount("--threads", options.threads, 1, settings, &Settings::set_threads)};
  std::string mistakes;
  for (const absl::Status& result : results)
    if (!result.ok())
      mistakes += (mistakes.empty() ? "" : "\n") + std::string(result.message().data(), result.message().size());
  if (!mistakes.empty()) return UsageError(mistakes);
  if (options.neighbour_clamping) settings.set_neighbour_clamping(true);
  if (options.overture) settings.set_overture(true);
  for (const std::string& name : options.no_skip) settings.add_no_skip(name);
  return settings;
}

}  // namespace flatlight
