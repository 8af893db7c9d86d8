// SPDX-License-Identifier: Apache-2.0
#include "client/cli/formats/result_shape.h"

#include <cmath>
#include <limits>

#include "client/cli/formats/result_columns.h"
#include "client/cli/text/numbers.h"

namespace flatlight {
namespace {

std::string FieldOf(const ResultColumn& column) {
  if (column.name == "x" || column.name == "y") return "positions";
  if (column.name == "nx" || column.name == "ny") return "normals";
  return column.name;
}

std::string FindProbeDefect(const v1::ProbeResult& probe, const std::string& path) {
  if (probe.channels() != 1 && probe.channels() != 3)
    return path + ".channels is " + std::to_string(probe.channels()) + ": must be 1 or 3";
  if (probe.count() > static_cast<unsigned>(std::numeric_limits<int>::max()) / 3)
    return path + ".count is " + std::to_string(probe.count()) + ": too many";
  if ((probe.has_width() || probe.has_height()) &&
      std::uint64_t{probe.width()} * probe.height() != std::uint64_t{probe.count()})
    return path + ".count is " + std::to_string(probe.count()) + ": must be width * height, " +
           std::to_string(probe.width()) + " * " + std::to_string(probe.height());
  if (probe.irradiance().empty() && probe.count() > 0) return path + ".irradiance is missing";
  for (const ResultColumn& column : AllResultColumns()) {
    const DoubleArray& values = column.values(probe);
    if (values.empty()) continue;
    const std::string field = path + "." + FieldOf(column);
    const auto stride = column.spectral() ? probe.channels() : static_cast<unsigned>(column.stride);
    if (static_cast<unsigned>(values.size()) != probe.count() * stride)
      return field + " has " + Plural(values.size(), "value") + ": must have " +
             std::to_string(probe.count() * stride) + ", from count " + std::to_string(probe.count()) +
             " and channels " + std::to_string(probe.channels());
    for (int i = 0; i < values.size(); ++i)
      if (!std::isfinite(values[i])) return field + "[" + std::to_string(i) + "] is " + FormatValue(values[i]);
  }
  return "";
}

}  // namespace

std::string FindResultDefect(const v1::RenderResult& result) {
  for (int i = 0; i < result.probes_size(); ++i) {
    std::string defect = FindProbeDefect(result.probes(i), "probes[" + std::to_string(i) + "]");
    if (!defect.empty()) return defect;
  }
  const v1::Statistics& statistics = result.statistics();
  if (!std::isfinite(statistics.error_bound()))
    return "statistics.errorBound is " + FormatValue(statistics.error_bound());
  return "";
}

}  // namespace flatlight
