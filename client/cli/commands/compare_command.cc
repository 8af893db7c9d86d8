// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/commands/result_input.h"
#include "client/cli/comparison/comparison.h"
#include "client/cli/formats/json_text.h"
#include "client/cli/outputs/outputs.h"
#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

std::string OptionalValue(const std::optional<double>& value) { return value ? FormatValue(*value, 3) : "-"; }

std::string Text(const Comparison& comparison) {
  std::vector<std::vector<std::string>> rows = {
      {"PROBE", "QUANTITY", "VALUES", "RMS", "MAX", "RELATIVE RMS", "MEAN Z", "MEAN Z^2", "VERDICT"}};
  for (const QuantityComparison& c : comparison.quantities)
    rows.push_back({Printable(c.probe), c.quantity, std::to_string(c.values), FormatValue(c.rms, 3),
                    FormatValue(c.largest, 3), OptionalValue(c.relative_rms), OptionalValue(c.mean_z),
                    OptionalValue(c.mean_z2), c.difference.empty() ? "equal" : "different"});
  std::string text = FormatTable(rows);
  for (const QuantityComparison& c : comparison.quantities)
    if (!c.difference.empty()) text += Printable(c.probe) + ": " + c.difference + '\n';
  if (comparison.worlds_differ) text += "note: the results are of different worlds (worldHash)\n";
  return text;
}

std::string Json(const Comparison& comparison) {
  nlohmann::ordered_json report;
  report["equal"] = comparison.Equal();
  report["worldsDiffer"] = comparison.worlds_differ;
  report["quantities"] = nlohmann::ordered_json::array();
  for (const QuantityComparison& c : comparison.quantities) {
    nlohmann::ordered_json entry = {{"probe", c.probe}, {"quantity", c.quantity}, {"values", c.values},
                                    {"rms", c.rms},     {"max", c.largest},       {"maxIndex", c.largest_index}};
    if (c.relative_rms) entry["relativeRms"] = *c.relative_rms;
    if (c.mean_z) entry["meanZ"] = *c.mean_z;
    if (c.mean_z2) entry["meanZ2"] = *c.mean_z2;
    entry["equal"] = c.difference.empty();
    if (!c.difference.empty()) entry["difference"] = c.difference;
    report["quantities"].push_back(entry);
  }
  return LayOutJson(report.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace

CommandResult CompareResults(const CommandLine& line, Interruption& interruption) {
  const auto a = ReadResult(line.results[0], interruption);
  if (!a.ok()) return a.status();
  const auto b = ReadResult(line.results[1], interruption);
  if (!b.ok()) return b.status();
  const auto comparison = Compare(*a, *b, line.tolerance);
  if (!comparison.ok()) return comparison.status();
  if (line.json || !line.quiet) {
    const absl::Status printed = PrintBytes(line.json ? Json(*comparison) : Text(*comparison));
    if (!printed.ok()) return printed;
  }
  return comparison->Equal() ? ExitCode::kDone : ExitCode::kDiffers;
}

}  // namespace flatlight
