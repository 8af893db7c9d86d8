// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/result_text.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "client/cli/formats/result_columns.h"
#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

constexpr double kDark = 0.01;

std::string QuantityName(const v1::ProbeResult& probe) {
  if (probe.quantity() == v1::ProbeResult::RADIANCE) return "radiance ";
  return probe.has_width() ? "fluence " : "irradiance ";
}

std::string RangeText(const v1::ProbeResult& probe) {
  if (probe.irradiance().empty()) return "no points";
  const int channels = static_cast<int>(probe.channels());
  std::optional<double> low, high;
  for (int i = 0; i < probe.irradiance_size(); ++i) {
    if (!IsKnown(probe, i / channels)) continue;
    low = std::min(low.value_or(probe.irradiance(i)), probe.irradiance(i));
    high = std::max(high.value_or(probe.irradiance(i)), probe.irradiance(i));
  }
  if (!low) return "unknown";
  return FormatValue(*low) + (*low == *high ? "" : " to " + FormatValue(*high)) +
         (probe.quantity() == v1::ProbeResult::RADIANCE ? " W/(rad m)" : " W/m");
}

int KnownPoints(const v1::ProbeResult& probe) {
  int known = 0;
  for (int point = 0; point < static_cast<int>(probe.count()); ++point) known += IsKnown(probe, point) ? 1 : 0;
  return known;
}

// Largest error / max(irradiance, 1 % of the probe's mean), as target_error has it; absent if there are none.
std::optional<double> LargestRelativeError(const v1::ProbeResult& probe,
                                           const google::protobuf::RepeatedField<double>& errors) {
  if (errors.empty()) return std::nullopt;
  const int channels = static_cast<int>(probe.channels());
  std::vector<double> mean(probe.channels());
  const int known = KnownPoints(probe);
  for (int i = 0; i < probe.irradiance_size(); ++i) {
    if (IsKnown(probe, i / channels)) mean[static_cast<std::size_t>(i % channels)] += probe.irradiance(i) / known;
  }
  double largest = 0;
  for (int i = 0; i < errors.size(); ++i) {
    const double scale = std::max(probe.irradiance(i), kDark * mean[static_cast<std::size_t>(i % channels)]);
    if (errors[i] > 0) largest = std::max(largest, errors[i] / scale);
  }
  return largest;
}

std::string BiasText(const v1::ProbeResult& probe) {
  const auto bias = LargestRelativeError(probe, probe.estimated_bias());
  return bias ? ", estimated bias " + FormatPercent(*bias) : "";
}

std::string ErrorText(const v1::RenderResult& result, const v1::ProbeResult& probe) {
  const int unknown = static_cast<int>(probe.count()) - KnownPoints(probe);
  if (unknown > 0)
    return "no samples at " + std::to_string(unknown) + " of " + std::to_string(probe.count()) + " points";
  if (const auto error = LargestRelativeError(probe, probe.standard_error()))
    return "largest relative standard error " + FormatPercent(*error) + BiasText(probe);
  if (const auto error = LargestRelativeError(probe, probe.estimated_error()))
    return "largest estimated relative error " + FormatPercent(*error);
  if (result.statistics().has_error_bound())
    return "error at most " + FormatValue(result.statistics().error_bound(), 2) + " W/m";
  return "";
}

std::string EndText(v1::EndReason reason) {
  switch (reason) {
    case v1::CONVERGED:
      return "finished";
    case v1::SAMPLES_DONE:
      return "all samples done";
    case v1::TARGET_REACHED:
      return "target error reached";
    case v1::TIME_LIMIT:
      return "time limit reached";
    case v1::ACCURACY_LIMIT:
      return "target error out of reach: ended";
    default:
      return "ended before its time";
  }
}

}  // namespace

std::string ResultText(const v1::RenderResult& result) {
  std::vector<std::vector<std::string>> rows;
  for (const v1::ProbeResult& probe : result.probes())
    rows.push_back({Printable(probe.name()), QuantityName(probe) + RangeText(probe), ErrorText(result, probe)});
  const v1::Statistics& statistics = result.statistics();
  std::string text = FormatTable(rows);
  text += EndText(result.end_reason()) + " in " + FormatSeconds(statistics.wall_seconds());
  if (statistics.has_cpu_seconds()) text += " (" + FormatSeconds(statistics.cpu_seconds()) + " of processor time)";
  if (statistics.photons() > 0) text += ", " + FormatCount(statistics.photons()) + " photons";
  if (statistics.has_records()) text += ", " + FormatCount(statistics.records()) + " records";
  if (statistics.has_reused_records()) text += " (" + FormatCount(statistics.reused_records()) + " reused)";
  if (statistics.rays() > 0) text += ", " + FormatCount(statistics.rays()) + " rays";
  return text + '\n';
}

}  // namespace flatlight
