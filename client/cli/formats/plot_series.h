// SPDX-License-Identifier: Apache-2.0
// The lines of a plot: one a probe and channel.
#ifndef FLATLIGHT_CLIENT_CLI_FORMATS_PLOT_SERIES_H_
#define FLATLIGHT_CLIENT_CLI_FORMATS_PLOT_SERIES_H_

#include <string>
#include <vector>

#include "flatlight/v1/result.pb.h"

namespace flatlight {

// A quantity of a probe: its name in a result, and what to write on the axis (gnuplot's enhanced text).
struct PlotQuantity {
  std::string values;  // A column of result_columns.h.
  std::string errors;
  std::string label;
};

struct PlotPoint {
  double place = 0;  // Arc length in m, or the number of the point.
  double value = 0;
  double error = 0;  // Half the width of the band; 0 if there is none.
};

struct PlotSeries {
  std::string title;  // Empty if the plot has but one line.
  int probe = 0;
  int channel = 0;
  std::vector<PlotPoint> points;
};

// Whether it is a picture of the plane, which no curve shows.
bool IsPicture(const v1::ProbeResult& probe);

// Whether the result is what cameras see, and nothing else: it is shown over the angle from the middle, in degrees.
bool HasCamerasAlone(const v1::RenderResult& result);

// Whether every probe with points has arc lengths.
bool HasArcLengths(const v1::RenderResult& result);

// Only probes that have the quantity, and no pictures. Bands are two standard errors; a deterministic result has none.
std::vector<PlotSeries> PlotSeriesOf(const v1::RenderResult& result, const PlotQuantity& quantity);

// At most about `limit` points: of every run of neighbours the lowest and the highest stay, in their order.
std::vector<PlotPoint> Thinned(const std::vector<PlotPoint>& points, std::size_t limit);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_FORMATS_PLOT_SERIES_H_
