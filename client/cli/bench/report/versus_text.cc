// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/report/versus_text.h"

#include <cmath>
#include <vector>

#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

// "1.02 (0.97 to 1.07)"; without noise, or if it is not known, there is no interval.
std::string RatioText(const std::optional<Ratio>& ratio) {
  if (!ratio) return "-";
  std::string value = FormatValue(ratio->value, 3);
  if (!std::isfinite(ratio->high) || ratio->low == ratio->high) return value;
  return value + " (" + FormatValue(ratio->low, 3) + " to " + FormatValue(ratio->high, 3) + ")";
}

std::string VerdictText(const PointVersus& point) {
  if (point.verdict != Change::kTooNoisy) return ChangeText(point.verdict);
  return ChangeText(point.verdict) + (point.runs_needed ? ": " + std::to_string(*point.runs_needed) + " runs would do"
                                                        : std::string(": more runs or seeds are needed"));
}

std::vector<std::string> Row(const PointVersus& point) {
  const std::string quantity =
      point.quantity == BenchQuantity::kIrradiance ? "" : std::string(" ") + NameOf(point.quantity);
  return {Printable(point.scene),
          Printable(point.method) + quantity,
          point.budget ? std::to_string(*point.budget) : "-",
          std::to_string(point.runs_a) + ", " + std::to_string(point.runs_b),
          RatioText(point.time),
          RatioText(point.error),
          RatioText(point.efficiency),
          VerdictText(point)};
}

}  // namespace

const char* ChangeText(Change change) {
  switch (change) {
    case Change::kBetter:
      return "better";
    case Change::kWorse:
      return "worse";
    case Change::kTooNoisy:
      return "too noisy to tell";
    default:
      return "no difference seen";
  }
}

std::string VersusText(const Versus& versus, const VersusOptions& options) {
  std::vector<std::vector<std::string>> table = {
      {"SCENE", "METHOD", "BUDGET", "RUNS A, B", "TIME B/A", "ERROR B/A", "EFFICIENCY B/A", "VERDICT"}};
  for (const PointVersus& point : versus.points) table.push_back(Row(point));
  PointVersus overall = versus.overall;
  overall.scene = "overall";
  overall.method = "geometric mean";
  table.push_back(Row(overall));
  if (overall.verdict == Change::kTooNoisy) table.back().back() = ChangeText(overall.verdict);
  std::string text = FormatTable(table);
  text += Plural(static_cast<double>(versus.points.size()), "point") + ": ";
  text += std::to_string(versus.Count(Change::kWorse)) + " worse, " + std::to_string(versus.Count(Change::kBetter)) +
          " better, " + std::to_string(versus.Count(Change::kNotSeen)) + " without a difference, " +
          std::to_string(versus.Count(Change::kTooNoisy)) + " too noisy. Changes below " +
          FormatPercent(options.least) + " do not count;\nof two benchmarks of the same, less than 1 in " +
          FormatValue(1 / options.failure_rate, 6) + " shows any point better or worse.\n";
  for (const std::string& note : versus.notes) text += "note: " + Printable(note) + '\n';
  return text;
}

}  // namespace flatlight
