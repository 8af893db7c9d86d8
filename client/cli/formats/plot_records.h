// SPDX-License-Identifier: Apache-2.0
// Cache records in a plot: a row for each curve and side, a mark at each record, a bar as far as it counts.
#ifndef FLATLIGHT_CLIENT_CLI_FORMATS_PLOT_RECORDS_H_
#define FLATLIGHT_CLIENT_CLI_FORMATS_PLOT_RECORDS_H_

#include <string>
#include <vector>

#include "flatlight/v1/result.pb.h"

namespace flatlight {

struct RecordRow {
  std::string title;                            // The curve, and its side if both have records.
  std::vector<const v1::CacheRecord*> records;  // On it, in the order of the result.
};

// Only records that lie on curves. The result must outlive them.
std::vector<RecordRow> RecordRowsOf(const v1::RenderResult& result);

// What draws the rows over arc length in a panel that is set up, the first one on top, each wave in its colour.
struct RecordPlot {
  std::string data;  // Blocks, to be defined before.
  std::string commands;
};
RecordPlot PlotOf(const std::vector<RecordRow>& rows);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_FORMATS_PLOT_RECORDS_H_
