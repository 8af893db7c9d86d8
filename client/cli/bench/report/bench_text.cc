// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/report/bench_text.h"

#include <algorithm>
#include <iterator>

#include "client/cli/bench/analysis/findings.h"
#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

using Table = std::vector<std::vector<std::string>>;

constexpr double kMissed = 0.05;  // By intervals that are shown.

std::string BudgetText(const std::optional<std::uint32_t>& budget) { return budget ? std::to_string(*budget) : "-"; }

std::string MethodText(const Curve& curve) {
  return curve.method + (curve.quantity == BenchQuantity::kIrradiance ? "" : std::string(" ") + NameOf(curve.quantity));
}

// Derivatives without an error to see say nothing that the irradiance does not say.
bool IsShown(const Curve& curve) { return curve.quantity == BenchQuantity::kIrradiance || !curve.IsExact(); }

// "0.0012 of 0.0013": what there is, of what noise alone would give.
std::string BiasText(const PointSummary& point) {
  if (!point.bias || point.relative <= kRoundingError) return "-";
  return FormatValue(point.bias->rms, 2) + " of " + FormatValue(point.bias->noise_rms, 2);
}

std::string EfficiencyText(const PointSummary& point) {
  const auto efficiency = point.Efficiency();
  return efficiency && point.relative > kRoundingError ? FormatCount(*efficiency) : "-";
}

std::string PointsTable(const std::vector<Curve>& curves) {
  const bool truth_errs = std::any_of(curves.begin(), curves.end(), [](const Curve& curve) {
    return std::any_of(curve.points.begin(), curve.points.end(),
                       [](const PointSummary& point) { return point.truth_relative > 0; });
  });
  Table table = {{"SCENE", "METHOD", "BUDGET", "RUNS", "CPU", "LEAST", "WALL", "RAYS", "RMS", "MAX", "RELATIVE", "BIAS",
                  "MEAN Z^2", "EFFICIENCY"}};
  if (truth_errs) table[0].push_back("TRUTH'S OWN");
  for (const Curve& curve : curves)
    for (const PointSummary& point : curve.points) {
      table.push_back({Printable(curve.scene), Printable(MethodText(curve)), BudgetText(point.budget),
                       std::to_string(point.runs), FormatSeconds(point.cpu_median), FormatSeconds(point.cpu_least),
                       FormatSeconds(point.wall_median), FormatCount(point.rays), FormatValue(point.rms, 3),
                       FormatValue(point.largest, 3), FormatPercent(point.relative), BiasText(point),
                       point.mean_z2 ? FormatValue(point.mean_z2->value, 3) : "-", EfficiencyText(point)});
      if (truth_errs) table.back().push_back(FormatPercent(point.truth_relative));
    }
  return FormatTable(table);
}

std::string CurvesTable(const std::vector<Curve>& curves) {
  Table table = {{"SCENE", "METHOD", "SLOPE OVER TIME", "OVER SAMPLES", "TO 1 %", "TO 0.1 %", "TO 0.01 %"}};
  for (const Curve& curve : curves) {
    table.push_back({Printable(curve.scene), Printable(MethodText(curve)), SlopeText(curve.over_time),
                     SlopeText(curve.over_samples)});
    for (const double error : kTargetErrors) table.back().push_back(TimeToText(TimeToError(curve, error)));
  }
  return FormatTable(table);
}

std::string Legend(const std::vector<Curve>& curves) {
  const auto any = [&curves](auto holds) { return std::any_of(curves.begin(), curves.end(), holds); };
  std::string text =
      "CPU, WALL  median over runs, LEAST the least processor time: as the server states them. All below is by CPU.\n"
      "RELATIVE   RMS error over RMS of the truth      EFFICIENCY  1 / (relative error^2 * processor time), 1/s\n";
  if (any([](const Curve& curve) { return curve.points.front().bias.has_value(); }))
    text += "BIAS       RMS error of the mean over seeds, of what noise alone would give: unbiased if they are alike\n";
  text +=
      "SLOPE      d log(error) / d log(time), with an interval of 95 %\n"
      "TO         processor time to a relative error: < a bound, ~ by the fit, beyond what was measured\n";
  return text;
}

std::string Truths(const std::vector<Curve>& curves) {
  std::vector<std::string> names;
  for (const Curve& curve : curves)
    if (std::find(names.begin(), names.end(), curve.truth) == names.end()) names.push_back(curve.truth);
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + Printable(name);
  return text;
}

}  // namespace

std::string SlopeText(const std::optional<PowerFit>& fit) {
  if (!fit) return "-";
  return FormatFixed(fit->slope.value, 2) + " +- " + FormatFixed(HalfWidth(fit->slope, kMissed), 2);
}

std::string TimeToText(const TimeTo& time) {
  switch (time.source) {
    case TimeTo::Source::kMeasured:
      return FormatSeconds(time.seconds);
    case TimeTo::Source::kAtMost:
      return "< " + FormatSeconds(time.seconds);
    case TimeTo::Source::kExtrapolated:
      return "~ " + FormatSeconds(time.seconds);
    default:
      return "-";
  }
}

std::string BenchText(const std::vector<Curve>& all, const std::vector<BenchRow>& rows) {
  std::vector<Curve> curves;
  std::copy_if(all.begin(), all.end(), std::back_inserter(curves), IsShown);
  if (curves.empty()) return "no runs\n";
  std::string text = PointsTable(curves) + '\n' + CurvesTable(curves) + '\n' + Legend(curves);
  text += "machine    " + Printable(MachineOf(rows.back())) + "; server " + Printable(rows.back().server) + "; truth " +
          Truths(curves) + '\n';
  for (const std::string& finding : FindingsOf(all)) text += "note: " + Printable(finding) + '\n';
  return text;
}

}  // namespace flatlight
