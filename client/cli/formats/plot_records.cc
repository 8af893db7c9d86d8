// SPDX-License-Identifier: Apache-2.0
#include "client/cli/formats/plot_records.h"

#include <algorithm>

#include "client/cli/formats/plot_style.h"
#include "client/cli/text/numbers.h"

namespace flatlight {
namespace {

constexpr std::size_t kWaveColours = 4;
constexpr const char* kColours[kWaveColours] = {"#0072B2", "#009E73", "#E69F00", "#CC79A7"};
constexpr const char* kWaves[kWaveColours] = {"first wave", "second", "third", "later waves"};
constexpr std::size_t kFirstLabel = 10;  // Of gnuplot's; smaller ones are the whole plot's.
constexpr double kTitle = 0.48;          // Above the middle of its row.
constexpr double kSpread = 0.45;         // Of a row's height, by which records keep out of each other's way.
constexpr std::size_t kLanes = 3;

}  // namespace

std::vector<RecordRow> RecordRowsOf(const v1::RenderResult& result) {
  std::vector<RecordRow> rows;
  for (const v1::CacheRecord& record : result.records()) {
    if (!record.has_arc_length() || record.radius_size() != 2) continue;
    const std::string title = record.curve() + (record.side() == v1::CacheRecord::BACK ? " (back)" : "");
    auto row = std::find_if(rows.begin(), rows.end(), [&](const RecordRow& r) { return r.title == title; });
    if (row == rows.end()) row = rows.insert(rows.end(), {title, {}});
    row->records.push_back(&record);
  }
  return rows;
}

RecordPlot PlotOf(const std::vector<RecordRow>& rows) {
  std::string blocks[kWaveColours];
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::vector<const v1::CacheRecord*> sorted = rows[r].records;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto* a, const auto* b) { return a->arc_length() < b->arc_length(); });
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      const v1::CacheRecord& record = *sorted[i];
      const double lane = (static_cast<double>(i % kLanes) + 0.5) / kLanes - 0.5;
      const double y = static_cast<double>(rows.size() - r) + kSpread * lane, s = record.arc_length();
      blocks[std::min<std::size_t>(record.wave(), kWaveColours - 1)] +=
          FormatExactly(s) + ' ' + FormatExactly(y) + ' ' + FormatExactly(s - record.radius(0)) + ' ' +
          FormatExactly(s + record.radius(1)) + '\n';
    }
  }
  std::string plots, data;
  // Above its records, not beside them: names may be long.
  std::string labels;
  for (std::size_t r = 0; r < rows.size(); ++r)
    labels += "set label " + std::to_string(kFirstLabel + r) + " " + PlotText(rows[r].title) +
              " at graph 0.004, first " + FormatExactly(static_cast<double>(rows.size() - r) + kTitle) +
              " left textcolor rgb '#606060' front\n";
  for (std::size_t wave = 0; wave < kWaveColours; ++wave) {
    if (blocks[wave].empty()) continue;
    const std::string name = "$wave" + std::to_string(wave), colour = std::string(" linecolor rgb '") + kColours[wave];
    data += name + " << EOD\n" + blocks[wave] + "EOD\n";
    plots += ", " + name + " using 1:2:3:4 with xerrorbars linewidth 1.2 pointtype 7 pointsize 0.4" + colour +
             "' title '" + kWaves[wave] + "'";
  }
  return {data, labels + "unset ytics\nset yrange [0.55:" + std::to_string(rows.size()) + ".8]\nplot " +
                    plots.substr(2) + '\n'};
}

}  // namespace flatlight
