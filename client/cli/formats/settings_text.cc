// SPDX-License-Identifier: Apache-2.0
#include "client/cli/formats/settings_text.h"

#include "client/cli/formats/enum_names.h"
#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"

namespace flatlight {

std::string SettingsText(const v1::Settings& settings) {
  std::string text;
  const auto add = [&text](const std::string& option, const std::string& value) {
    text += (text.empty() ? "--" : " --") + option + ' ' + value;
  };
  if (settings.method() != 0) add("method", OptionName(settings.method()));
  if (settings.has_samples()) add("samples", std::to_string(settings.samples()));
  if (settings.has_max_bounces()) add("max-bounces", std::to_string(settings.max_bounces()));
  if (settings.has_seed()) add("seed", std::to_string(settings.seed()));
  if (settings.derivatives() != 0) add("derivatives", OptionName(settings.derivatives()));
  if (settings.formulation() != 0) add("formulation", OptionName(settings.formulation()));
  if (settings.error_control() != 0) add("error-control", OptionName(settings.error_control()));
  if (settings.gather() != 0) add("gather", OptionName(settings.gather()));
  if (settings.has_extrapolation()) add("extrapolation", std::to_string(settings.extrapolation()));
  if (settings.has_tolerance()) add("tolerance", FormatExactly(settings.tolerance()));
  if (settings.has_max_records()) add("max-records", std::to_string(settings.max_records()));
  if (settings.has_photons()) add("photons", std::to_string(settings.photons()));
  if (settings.has_final_gather()) add("final-gather", settings.final_gather() ? "true" : "false");
  if (settings.has_bandwidth()) add("bandwidth", FormatExactly(settings.bandwidth()));
  if (settings.has_neighbours()) add("neighbours", std::to_string(settings.neighbours()));
  if (settings.kernel() != 0) add("kernel", OptionName(settings.kernel()));
  if (settings.has_target_error()) add("target-error", FormatExactly(settings.target_error()));
  if (settings.has_time_limit()) add("time-limit", FormatExactly(settings.time_limit()));
  if (settings.has_threads()) add("threads", std::to_string(settings.threads()));
  for (const std::string& name : settings.no_skip()) add("no-skip", Printable(name));
  return text;
}

}  // namespace flatlight
