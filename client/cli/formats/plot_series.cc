// SPDX-License-Identifier: Apache-2.0
#include "client/cli/formats/plot_series.h"

#include <algorithm>

#include "client/cli/formats/result_columns.h"

namespace flatlight {
namespace {

constexpr std::size_t kMostPoints = 4000;  // Twice the width of the picture, in pixels.

const ResultColumn& Column(const std::string& name) {
  const auto& columns = AllResultColumns();
  return *std::find_if(columns.begin(), columns.end(), [&name](const ResultColumn& c) { return c.name == name; });
}

std::string Title(const v1::RenderResult& result, int probe, int channel) {
  const bool coloured = result.probes(probe).channels() == 3;
  std::string title;
  if (result.probes_size() > 1) title = result.probes(probe).name();
  if (coloured) title += (title.empty() ? "" : " ") + std::string(1, "RGB"[channel]);
  return title;
}

}  // namespace

bool HasArcLengths(const v1::RenderResult& result) {
  return std::all_of(result.probes().begin(), result.probes().end(), [](const v1::ProbeResult& probe) {
    return probe.count() == 0 || probe.has_width() || !probe.arc_length().empty();
  });
}

std::vector<PlotSeries> PlotSeriesOf(const v1::RenderResult& result, const PlotQuantity& quantity) {
  const ResultColumn& values = Column(quantity.values);
  const ResultColumn& errors = Column(quantity.errors);
  const bool arc_lengths = HasArcLengths(result);
  std::vector<PlotSeries> all;
  for (int number = 0; number < result.probes_size(); ++number) {
    const v1::ProbeResult& probe = result.probes(number);
    if (values.values(probe).empty() || probe.has_width()) continue;
    const bool band = !probe.standard_error().empty() && !errors.values(probe).empty();
    for (int channel = 0; channel < static_cast<int>(probe.channels()); ++channel) {
      PlotSeries series{Title(result, number, channel), number, channel, {}};
      for (int i = 0; i < static_cast<int>(probe.count()); ++i)
        series.points.push_back({arc_lengths ? probe.arc_length(i) : i, ColumnValue(values, probe, i, channel),
                                 band ? 2 * ColumnValue(errors, probe, i, channel) : 0});
      series.points = Thinned(series.points, kMostPoints);
      all.push_back(std::move(series));
    }
  }
  return all;
}

std::vector<PlotPoint> Thinned(const std::vector<PlotPoint>& points, std::size_t limit) {
  if (points.size() <= limit) return points;
  const std::size_t runs = std::max<std::size_t>(1, limit / 2);
  std::vector<PlotPoint> thinned;
  for (std::size_t run = 0; run < runs; ++run) {
    const auto begin = points.begin() + static_cast<std::ptrdiff_t>(run * points.size() / runs);
    const auto end = points.begin() + static_cast<std::ptrdiff_t>((run + 1) * points.size() / runs);
    const auto [low, high] =
        std::minmax_element(begin, end, [](const PlotPoint& a, const PlotPoint& b) { return a.value < b.value; });
    thinned.push_back(std::min(low, high)[0]);
    if (low != high) thinned.push_back(std::max(low, high)[0]);
  }
  return thinned;
}

}  // namespace flatlight
