// SPDX-License-Identifier: Apache-2.0
#include "client/cli/formats/plot_script.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "client/cli/formats/enum_names.h"
#include "client/cli/formats/plot_records.h"
#include "client/cli/formats/plot_series.h"
#include "client/cli/formats/plot_style.h"
#include "client/cli/text/numbers.h"

namespace flatlight {
namespace {

constexpr std::array<const char*, 3> kChannelColours = {"#D55E00", "#009E73", "#0072B2"};

constexpr const char* kBandStyle = " fillstyle transparent solid 0.25 noborder fillcolor rgb ";

constexpr int kWidth = 900;  // Of the picture, in pixels (PNG: twice that).
constexpr int kHead = 74;    // Height of title and legend.
constexpr int kFirstPanel = 300;
constexpr int kOtherPanel = 190;
constexpr int kRecordRow = 46;        // Of the panel of records, for each row,
constexpr int kRecords = 26;          // and for its legend.
constexpr int kGap = 16;              // Between panels.
constexpr int kFoot = 58;             // Height of the axis at the bottom.
constexpr std::size_t kMarkers = 48;  // Up to this many points are marked.

std::string Subtitle(const v1::RenderResult& result) {
  v1::Settings::Method method = result.plan().settings().method();
  if (method == v1::Settings::METHOD_UNSPECIFIED) method = result.settings().method();
  // Of several methods together none is named.
  std::string text = method == v1::Settings::METHOD_UNSPECIFIED ? "" : OptionName(method) + ", ";
  double samples = 0;
  for (const v1::ProbeResult& probe : result.probes())
    for (const double n : probe.samples()) samples = std::max(samples, n);
  const bool paths = method == v1::Settings::PATH_TRACING;
  if (samples > 0) text += FormatExactly(samples) + (paths ? " paths a point, " : " rays a point, ");
  if (result.statistics().error_bound() > 0)
    text += "error below " + FormatValue(result.statistics().error_bound(), 2) + " W/m, ";
  return text.substr(0, text.size() - std::min<std::size_t>(text.size(), 2));
}

struct Panel {
  PlotQuantity quantity;
  std::vector<PlotSeries> series;
};

std::vector<Panel> Panels(const v1::RenderResult& result) {
  const std::array<PlotQuantity, 3> quantities = {
      PlotQuantity{"irradiance", "standardError",
                   HasCamerasAlone(result) ? "radiance  {/:Italic L}  [W/(rad m)]" : "irradiance  {/:Italic E}  [W/m]"},
      PlotQuantity{"gradient", "gradientError", "{/:Italic dE/ds}  [W/m^2]"},
      PlotQuantity{"hessian", "hessianError", "{/:Italic d}^2{/:Italic E/ds}^2  [W/m^3]"}};
  std::vector<Panel> panels;
  for (const PlotQuantity& quantity : quantities) {
    Panel panel{quantity, PlotSeriesOf(result, quantity)};
    if (panels.empty() || !panel.series.empty()) panels.push_back(std::move(panel));
  }
  return panels;
}

std::string BlockName(const Panel& panel, std::size_t series) {
  return "$" + panel.quantity.values + std::to_string(series);
}

std::string DataBlocks(const Panel& panel) {
  std::string text;
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    text += BlockName(panel, i) + " << EOD\n";
    for (const PlotPoint& point : panel.series[i].points)
      text += FormatExactly(point.place) + ' ' + FormatExactly(point.value) + ' ' + FormatExactly(point.error) + '\n';
    text += "EOD\n";
  }
  return text;
}

bool HasBand(const PlotSeries& series) {
  return std::any_of(series.points.begin(), series.points.end(), [](const PlotPoint& p) { return p.error > 0; });
}

std::string Colour(const PlotSeries& series, bool coloured) {
  if (coloured) return kChannelColours[static_cast<std::size_t>(series.channel)];
  return kPlotColours[static_cast<std::size_t>(series.probe) % kPlotColours.size()];
}

// Bands first, so that no line is covered.
std::string PlotCommand(const Panel& panel) {
  const bool coloured =
      std::any_of(panel.series.begin(), panel.series.end(), [](const PlotSeries& s) { return s.channel > 0; });
  std::string bands, lines;
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    const PlotSeries& series = panel.series[i];
    if (series.points.empty()) continue;
    const std::string colour = Colour(series, coloured);
    if (HasBand(series)) {
      bands += ", " + BlockName(panel, i) + " using 1:($2-$3):($2+$3) with filledcurves" + kBandStyle + "'" + colour +
               "' notitle";
    }
    const bool marked = series.points.size() <= kMarkers;
    lines += ", " + BlockName(panel, i) + " using 1:2 with " +
             (marked ? "linespoints pointtype 7 pointsize 0.45" : "lines") + " linewidth 1.6 linecolor rgb '" + colour +
             "'" + (coloured ? " dashtype " + std::to_string(series.probe % 5 + 1) : "") + " title " +
             PlotText(series.title);
  }
  const std::string legend =
      bands.empty() ? ""
                    : std::string(", keyentry with filledcurves") + kBandStyle + "'#606060' title '±2 standard errors'";
  const std::string all = bands + lines + legend;
  return all.empty() ? "plot NaN notitle\n" : "plot " + all.substr(2) + '\n';
}

// By how many letters columns are to be wider than gnuplot thinks, which takes long names for longer than they are.
std::string LegendWidth(const std::vector<Panel>& panels) {
  constexpr std::size_t kShort = 4;
  std::size_t longest = 0;
  for (const Panel& panel : panels)
    for (const PlotSeries& series : panel.series) longest = std::max(longest, series.title.size());
  return longest <= kShort ? "2" : "-2";
}

std::string RangeCommand(const Panel& panel) {
  double low = 0, high = 0;
  for (const PlotSeries& series : panel.series)
    for (const PlotPoint& point : series.points) {
      low = std::min(low, point.value - point.error);
      high = std::max(high, point.value + point.error);
    }
  // An autoscaled axis fails on lines that are zero everywhere, and makes a constant look like noise.
  if (low == 0 && high == 0) return "set yrange [-1:1]\n";
  const bool from_zero = panel.quantity.values == "irradiance" && low == 0;
  const double margin = 0.06 * (high - low);
  return "set yrange [" + FormatExactly(from_zero ? 0 : low - margin) + ":" + FormatExactly(high + margin) + "]\n";
}

}  // namespace

std::string PlotScript(const v1::RenderResult& result, PlotForm form) {
  const std::vector<Panel> panels = Panels(result);
  // Over another axis they mean nothing.
  const std::vector<RecordRow> rows = HasArcLengths(result) ? RecordRowsOf(result) : std::vector<RecordRow>();
  const int records = rows.empty() ? 0 : kRecords + static_cast<int>(rows.size()) * kRecordRow;
  const int height = kHead + kFirstPanel + static_cast<int>(panels.size() - 1) * (kGap + kOtherPanel) +
                     (records > 0 ? kGap + records : 0) + kFoot;
  const auto screen = [height](int y) { return FormatValue(1 - static_cast<double>(y) / height, 6); };

  std::string script = PlotTerminal(form, kWidth, height);
  for (const Panel& panel : panels) script += DataBlocks(panel);
  const RecordPlot record_plot = rows.empty() ? RecordPlot() : PlotOf(rows);
  script += record_plot.data;
  script +=
      "set encoding utf8\nset multiplot\nset border 3 linecolor rgb '#404040' linewidth 0.8\n"
      "set tics nomirror scale 0.5 textcolor rgb '#404040'\nset grid linetype 1 linecolor rgb '#e4e4e4' linewidth 0.5\n"
      "set xzeroaxis linetype 1 linecolor rgb '#a0a0a0' linewidth 0.6\nset autoscale xfix\n"
      "set lmargin at screen 0.115\nset rmargin at screen 0.975\nset format y '%.4g'\n"
      "set label 1 '{/:Bold*1.35 '." +
      PlotText(result.scene().empty() ? "irradiance" : result.scene()) + ".'}' at screen 0.02, screen " + screen(24) +
      " left\n" + "set label 2 " + PlotText(Subtitle(result)) + " at screen 0.02, screen " + screen(50) +
      " left textcolor rgb '#606060'\n" + "set key at screen 0.975, screen " + screen(14) +
      " right top horizontal Left reverse maxrows 3 samplen 1.8 spacing 1.2 width " + LegendWidth(panels) +
      " textcolor rgb '#404040'\n";

  int top = kHead;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const int bottom = top + (i == 0 ? kFirstPanel : kOtherPanel);
    const bool last = i + 1 == panels.size() && rows.empty();
    script += "set tmargin at screen " + screen(top) + "\nset bmargin at screen " + screen(bottom) + "\n";
    // Not a ylabel: its place would depend on the width of the numbers, and differ from panel to panel.
    script += "set label 3 '" + panels[i].quantity.label + "' at screen 0.036, screen " + screen((top + bottom) / 2) +
              " center rotate by 90\n" + RangeCommand(panels[i]);
    if (last) {
      script += HasCamerasAlone(result) ? "set xlabel 'angle from the middle  [degrees]'\nset format x '%g'\n"
                : HasArcLengths(result) ? "set xlabel 'arc length  {/:Italic s}  [m]'\nset format x '%g'\n"
                                        : "set xlabel 'point'\nset format x '%g'\n";
    } else {
      script += "unset xlabel\nset format x ''\n";
    }
    script += PlotCommand(panels[i]) + "unset label\nunset key\n";
    top = bottom + kGap;
  }
  if (!rows.empty()) {
    // The panels above have set the range of the axis.
    script +=
        "set tmargin at screen " + screen(top + kRecords) + "\nset bmargin at screen " + screen(top + records) +
        "\nset xrange [GPVAL_X_MIN:GPVAL_X_MAX]\nset xlabel 'arc length  {/:Italic s}  [m]'\nset format x '%g'\n" +
        "set format y '%s'\nset key at screen 0.975, screen " + screen(top + kRecords / 2) +
        " right center horizontal Left reverse samplen 1.8 width -2 textcolor rgb '#404040'\n" + record_plot.commands;
  }
  return script + "unset multiplot\n";
}

}  // namespace flatlight
