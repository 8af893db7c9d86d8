// SPDX-License-Identifier: Apache-2.0
#include "client/cli/formats/result_columns.h"

#include <algorithm>

namespace flatlight {

const std::vector<ResultColumn>& AllResultColumns() {
  using Probe = v1::ProbeResult;
  static const std::vector<ResultColumn> kColumns = {
      {"x", [](const Probe& p) -> const DoubleArray& { return p.positions(); }, 2, 0},
      {"y", [](const Probe& p) -> const DoubleArray& { return p.positions(); }, 2, 1},
      {"nx", [](const Probe& p) -> const DoubleArray& { return p.normals(); }, 2, 0},
      {"ny", [](const Probe& p) -> const DoubleArray& { return p.normals(); }, 2, 1},
      {"arcLength", [](const Probe& p) -> const DoubleArray& { return p.arc_length(); }, 1, 0},
      {"irradiance", [](const Probe& p) -> const DoubleArray& { return p.irradiance(); }, 0, 0},
      {"standardError", [](const Probe& p) -> const DoubleArray& { return p.standard_error(); }, 0, 0},
      {"irradianceError", [](const Probe& p) -> const DoubleArray& { return p.irradiance_error(); }, 0, 0},
      {"estimatedError", [](const Probe& p) -> const DoubleArray& { return p.estimated_error(); }, 0, 0},
      {"estimatedBias", [](const Probe& p) -> const DoubleArray& { return p.estimated_bias(); }, 0, 0},
      {"gradient", [](const Probe& p) -> const DoubleArray& { return p.gradient(); }, 0, 0},
      {"gradientError", [](const Probe& p) -> const DoubleArray& { return p.gradient_error(); }, 0, 0},
      {"hessian", [](const Probe& p) -> const DoubleArray& { return p.hessian(); }, 0, 0},
      {"hessianError", [](const Probe& p) -> const DoubleArray& { return p.hessian_error(); }, 0, 0},
      {"rotationGradient", [](const Probe& p) -> const DoubleArray& { return p.rotation_gradient(); }, 0, 0},
      {"rotationGradientError", [](const Probe& p) -> const DoubleArray& { return p.rotation_gradient_error(); }, 0, 0},
      {"samples", [](const Probe& p) -> const DoubleArray& { return p.samples(); }, 1, 0}};
  return kColumns;
}

std::vector<ResultColumn> ResultColumnsOf(const v1::RenderResult& result) {
  std::vector<ResultColumn> present;
  for (const ResultColumn& column : AllResultColumns()) {
    const auto has = [&column](const v1::ProbeResult& probe) { return !column.values(probe).empty(); };
    if (std::any_of(result.probes().begin(), result.probes().end(), has)) present.push_back(column);
  }
  return present;
}

int ResultChannels(const v1::RenderResult& result) {
  int channels = 1;
  for (const v1::ProbeResult& probe : result.probes())
    channels = std::max(channels, static_cast<int>(probe.channels()));
  return channels;
}

bool IsKnown(const v1::ProbeResult& probe, int point) { return probe.samples().empty() || probe.samples(point) > 0; }

bool HasValue(const ResultColumn& column, const v1::ProbeResult& probe, int point) {
  return !column.values(probe).empty() && (!column.spectral() || IsKnown(probe, point));
}

double ColumnValue(const ResultColumn& column, const v1::ProbeResult& probe, int point, int channel) {
  if (!column.spectral()) return column.values(probe)[point * column.stride + column.offset];
  const int channels = static_cast<int>(probe.channels());
  return column.values(probe)[point * channels + std::min(channel, channels - 1)];
}

}  // namespace flatlight
