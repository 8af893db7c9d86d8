// SPDX-License-Identifier: Apache-2.0
#include "client/cli/formats/plot_series.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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

// Of a camera's pixel from the middle of the line; the first ones are below 0.
double DegreesOff(const v1::ProbeResult& camera, int pixel) {
  const auto& looks = camera.normals();
  const int last = static_cast<int>(camera.count()) - 1;
  const double x = looks[0] + looks[2 * last], y = looks[1] + looks[2 * last + 1];
  const auto angle_to = [&](int i) {
    return std::atan2(x * looks[2 * i + 1] - y * looks[2 * i], x * looks[2 * i] + y * looks[2 * i + 1]);
  };
  return (angle_to(last) < 0 ? -1 : 1) * angle_to(pixel) * 180 / std::numbers::pi;
}

}  // namespace

bool IsPicture(const v1::ProbeResult& probe) {
  return probe.has_width() && probe.quantity() != v1::ProbeResult::RADIANCE;
}

bool HasCamerasAlone(const v1::RenderResult& result) {
  const auto& probes = result.probes();
  return !probes.empty() && std::all_of(probes.begin(), probes.end(), [](const v1::ProbeResult& probe) {
    return probe.quantity() == v1::ProbeResult::RADIANCE && probe.normals_size() == 2 * static_cast<int>(probe.count());
  });
}

bool HasArcLengths(const v1::RenderResult& result) {
  return std::all_of(result.probes().begin(), result.probes().end(), [](const v1::ProbeResult& probe) {
    return probe.count() == 0 || IsPicture(probe) || !probe.arc_length().empty();
  });
}

std::vector<PlotSeries> PlotSeriesOf(const v1::RenderResult& result, const PlotQuantity& quantity) {
  const ResultColumn& values = Column(quantity.values);
  const ResultColumn& errors = Column(quantity.errors);
  const bool arc_lengths = HasArcLengths(result), angles = HasCamerasAlone(result);
  std::vector<PlotSeries> all;
  for (int number = 0; number < result.probes_size(); ++number) {
    const v1::ProbeResult& probe = result.probes(number);
    if (values.values(probe).empty() || IsPicture(probe)) continue;
    const bool band = !probe.standard_error().empty() && !errors.values(probe).empty();
    for (int channel = 0; channel < static_cast<int>(probe.channels()); ++channel) {
      PlotSeries series{Title(result, number, channel), number, channel, {}};
      for (int i = 0; i < static_cast<int>(probe.count()); ++i) {
        if (!IsKnown(probe, i)) continue;
        series.points.push_back({angles        ? DegreesOff(probe, i)
                                 : arc_lengths ? probe.arc_length(i)
                                               : i,
                                 ColumnValue(values, probe, i, channel),
                                 band ? 2 * ColumnValue(errors, probe, i, channel) : 0});
      }
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
