// SPDX-License-Identifier: Apache-2.0
// The options that say how a scene is rendered.
#ifndef FLATLIGHT_CLIENT_CLI_OPTIONS_SETTINGS_OPTIONS_H_
#define FLATLIGHT_CLIENT_CLI_OPTIONS_SETTINGS_OPTIONS_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "flatlight/v1/scene.pb.h"
#include "flatlight/v1/settings.pb.h"

namespace flatlight {

// As written on the command line.
struct SettingsOptions {
  std::optional<std::string> method, samples, max_bounces, seed, derivatives, formulation, target_error, time_limit,
      threads, error_control, gather, extrapolation, tolerance, max_records, photons, final_gather, bandwidth,
      neighbours, kernel;
  bool neighbour_clamping = false, overture = false;
  std::vector<std::string> no_skip;
};

// Values out of range end with ExitCode::kUsage: "--samples: '-5'; must be a whole number from 1 to 4294967295".
absl::StatusOr<v1::Settings> ParseSettings(const SettingsOptions& options);

// "WIDTHxHEIGHT": a picture of the whole scene of so many pixels.
absl::StatusOr<v1::Probe> ParsePicture(const std::string& text);

// An age in s, from 0, 30s, 90m, 12h or 30d.
absl::StatusOr<double> ParseAge(const std::string& option, const std::string& text);

// A number in (0, `high`], or from 0 if `zero` is allowed.
enum class Zero { kAllowed, kRefused };
absl::StatusOr<double> ParseNumber(const std::string& option, const std::string& text, Zero zero, double high);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_OPTIONS_SETTINGS_OPTIONS_H_
