// SPDX-License-Identifier: Apache-2.0
#include "client/cli/formats/csv.h"

#include "client/cli/formats/csv_syntax.h"
#include "client/cli/formats/result_columns.h"
#include "client/cli/text/numbers.h"

namespace flatlight {

std::string ResultToCsv(const v1::RenderResult& result, const std::function<bool()>& stop) {
  const std::vector<ResultColumn> columns = ResultColumnsOf(result);
  const int channels = ResultChannels(result);
  const auto width = [channels](const ResultColumn& column) { return column.spectral() ? channels : 1; };

  std::string csv = "probe,index";
  for (const ResultColumn& column : columns)
    for (int channel = 0; channel < width(column); ++channel)
      csv += ',' + column.name + (width(column) == 3 ? std::string(1, "RGB"[channel]) : "");
  csv += '\n';

  for (const v1::ProbeResult& probe : result.probes()) {
    const std::string name = CsvText(probe.name());
    for (int point = 0; point < static_cast<int>(probe.count()); ++point) {
      if (point % kPointsBetweenStops == 0 && stop()) return csv;
      csv += name + ',' + std::to_string(point);
      for (const ResultColumn& column : columns)
        for (int channel = 0; channel < width(column); ++channel) {
          csv += ',';
          if (HasValue(column, probe, point)) csv += FormatExactly(ColumnValue(column, probe, point, channel));
        }
      csv += '\n';
    }
  }
  return csv;
}

}  // namespace flatlight
