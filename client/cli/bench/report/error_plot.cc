// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/report/error_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "client/cli/text/numbers.h"

namespace flatlight {
namespace {

constexpr int kHead = 56;  // Pixels: title, below it the panels.
constexpr int kFoot = 14;
constexpr std::size_t kMostColumns = 3;

struct Panel {
  std::string scene;
  BenchQuantity quantity;
  std::vector<const Curve*> curves;
};

// Panels of quantities without any error say nothing; those of irradiance are there all the same.
std::vector<Panel> PanelsOf(const std::vector<Curve>& curves) {
  std::vector<Panel> panels;
  for (const Curve& curve : curves) {
    const auto panel = std::find_if(panels.begin(), panels.end(), [&curve](const Panel& p) {
      return p.scene == curve.scene && p.quantity == curve.quantity;
    });
    (panel == panels.end() ? panels.emplace_back(Panel{curve.scene, curve.quantity, {}}) : *panel)
        .curves.push_back(&curve);
  }
  std::erase_if(panels, [](const Panel& panel) {
    return panel.quantity != BenchQuantity::kIrradiance &&
           std::all_of(panel.curves.begin(), panel.curves.end(), [](const Curve* c) { return c->IsExact(); });
  });
  return panels;
}

std::vector<std::string> MethodsOf(const std::vector<Curve>& curves) {
  std::vector<std::string> methods;
  for (const Curve& curve : curves)
    if (std::find(methods.begin(), methods.end(), curve.method) == methods.end()) methods.push_back(curve.method);
  return methods;
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = 0;
  void Add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  // With some room, or something to show if there is nothing.
  std::string Command(const char* axis) const {
    const bool any = low <= high && low > 0;
    return std::string("set ") + axis + "range [" + FormatExactly(any ? low / 1.6 : 0.1) + ":" +
           FormatExactly(any ? high * 1.6 : 10) + "]\n";
  }
};

double Bar(const PointSummary& point) { return std::exp(2 * std::sqrt(point.log_variance)); }

std::string LineStyle(const std::string& colour) { return " linewidth 1.6 linecolor rgb '" + colour + "'"; }

std::string Title(const Curve& curve) {
  if (curve.IsExact()) return curve.method + ", no error seen";
  if (!curve.over_time) return curve.method;
  return curve.method + ", slope " + FormatFixed(curve.over_time->slope.value, 2) + " ± " +
         FormatFixed(HalfWidth(curve.over_time->slope, 0.05), 2);
}

// Time, error, and the ends of its bar.
std::string PointText(const PointSummary& point) {
  return FormatExactly(point.cpu_median) + ' ' + FormatExactly(point.relative) + ' ' +
         FormatExactly(point.relative / Bar(point)) + ' ' + FormatExactly(point.relative * Bar(point)) + '\n';
}

// Its two ends, over the times of the points that it was fitted to.
std::string FittedLine(const Curve& curve) {
  Range times;
  for (const PointSummary& point : curve.points)
    if (point.cpu_median > 0 && point.relative > kRoundingError) times.Add(point.cpu_median);
  std::string line;
  for (const double x : {times.low, times.high})
    line += FormatExactly(x) + ' ' + FormatExactly(std::exp(curve.over_time->At(std::log(x)).value)) + '\n';
  return line;
}

// What gnuplot is to plot of a curve; empty if there is nothing that logarithmic axes can show.
std::string PlotCurve(const Curve& curve, const std::string& name, const std::string& colour, std::string& blocks) {
  const std::string title = " title " + PlotText(Title(curve));
  std::string points, verticals;
  for (const PointSummary& point : curve.points) {
    if (point.cpu_median <= 0) continue;
    if (point.relative > kRoundingError) points += PointText(point);
    for (const char* y : {"1e-30", "1e30"}) verticals += FormatExactly(point.cpu_median) + ' ' + y + '\n';
  }
  if (curve.IsExact()) {
    blocks += "$" + name + " << EOD\n" + verticals + "EOD\n";
    return verticals.empty() ? "" : ", $" + name + " using 1:2 with lines dashtype 2" + LineStyle(colour) + title;
  }
  if (points.empty()) return "";
  blocks += "$" + name + " << EOD\n" + points + "EOD\n";
  std::string plot = ", $" + name + " using 1:2:3:4 with yerrorbars pointtype 7 pointsize 0.5" + LineStyle(colour) +
                     (curve.over_time ? " notitle" : title);
  if (curve.over_time) {
    blocks += "$" + name + "fit << EOD\n" + FittedLine(curve) + "EOD\n";
    plot += ", $" + name + "fit using 1:2 with lines" + LineStyle(colour) + title;
  }
  return plot;
}

std::string PlotPanel(const Panel& panel, std::size_t number, const std::vector<std::string>& methods) {
  Range times, errors;
  std::string blocks, plots;
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    const Curve& curve = *panel.curves[i];
    for (const PointSummary& point : curve.points) {
      if (point.cpu_median <= 0) continue;
      times.Add(point.cpu_median);
      if (point.relative <= kRoundingError) continue;
      errors.Add(point.relative / Bar(point));
      errors.Add(point.relative * Bar(point));
    }
    const auto method = std::find(methods.begin(), methods.end(), curve.method) - methods.begin();
    const std::string colour = kPlotColours[static_cast<std::size_t>(method) % kPlotColours.size()];
    plots += PlotCurve(curve, "d" + std::to_string(number) + "_" + std::to_string(i), colour, blocks);
  }
  std::string heading = panel.scene;
  if (panel.quantity != BenchQuantity::kIrradiance) heading += std::string(", ") + NameOf(panel.quantity);
  return blocks + times.Command("x") + errors.Command("y") + "set title " + PlotText(heading) + " offset 0,-0.4\n" +
         "plot " + (plots.empty() ? "NaN notitle" : plots.substr(2)) + '\n';
}

}  // namespace

std::string ErrorPlotScript(const std::vector<Curve>& curves, PlotForm form) {
  const std::vector<Panel> panels = PanelsOf(curves);
  const std::vector<std::string> methods = MethodsOf(curves);
  const std::size_t columns = std::clamp<std::size_t>(panels.size(), 1, kMostColumns);
  const std::size_t rows = std::max<std::size_t>(1, (panels.size() + columns - 1) / columns);
  const int panel_width = columns == 1 ? 900 : 460, panel_height = columns == 1 ? 480 : 360;
  const int width = panel_width * static_cast<int>(columns);
  const int height = kHead + panel_height * static_cast<int>(rows) + kFoot;
  const auto part = [](int a, int b) { return FormatValue(static_cast<double>(a) / b, 6); };

  std::string script = PlotTerminal(form, width, height);
  script +=
      "set encoding utf8\nset border 3 linecolor rgb '#404040' linewidth 0.8\n"
      "set tics nomirror scale 0.5 textcolor rgb '#404040'\n"
      "set grid linetype 1 linecolor rgb '#e4e4e4' linewidth 0.5\nset logscale xy\nset clip two\n"
      "set format x '10^{%L}'\nset format y '10^{%L}'\n"
      "set key bottom left Left reverse samplen 1.8 spacing 1.2 textcolor rgb '#404040'\n"
      "set xlabel 'processor time  [s]'\nset ylabel 'relative RMS error'\n";
  script += "set label 1 '{/:Bold*1.35 Error against time}' at screen " + part(18, width) + ", screen " +
            part(height - 24, height) + " left\n";
  if (panels.empty()) return script + "set xrange [0.1:10]\nset yrange [0.1:10]\nplot NaN notitle\n";
  script += "set multiplot layout " + std::to_string(rows) + "," + std::to_string(columns) + " margins screen " +
            part(84, width) + "," + part(width - 24, width) + "," + part(kFoot + 44, height) + "," +
            part(height - kHead - 24, height) + " spacing screen " + part(96, width) + "," + part(84, height) + "\n";
  for (std::size_t i = 0; i < panels.size(); ++i) {
    script += PlotPanel(panels[i], i, methods);
    if (i == 0) script += "unset label 1\n";
  }
  return script + "unset multiplot\n";
}

}  // namespace flatlight
