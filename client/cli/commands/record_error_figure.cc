// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/record_error_figure.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "client/cli/commands/console.h"
#include "client/cli/commands/figure_drawing.h"
#include "client/cli/commands/session.h"
#include "client/cli/comparison/comparison.h"
#include "client/cli/formats/enum_names.h"
#include "client/cli/formats/gnuplot.h"
#include "client/cli/formats/plot_style.h"
#include "client/cli/outputs/atomic_file.h"
#include "client/cli/outputs/outputs.h"
#include "client/cli/status/exit_code.h"
#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

constexpr std::array<std::uint32_t, 6> kBudgets = {4, 8, 12, 16, 32, 64};
constexpr std::uint32_t kShown = 16;  // In the table.
constexpr std::array<const char*, 2> kScenes = {"blocker", "black-wall"};
constexpr std::uint32_t kDegrees = 3;

struct Line {
  std::string scene;
  std::uint32_t degree = 0;
  std::string control;
  std::vector<std::pair<double, double>> points;  // Records made, relative RMS error.

  double ErrorWith(std::uint32_t budget) const {
    for (std::size_t i = 0; i < points.size(); ++i)
      if (kBudgets[i] == budget) return points[i].second;
    return 0;
  }
};

absl::StatusOr<std::vector<Line>> Measure(Session& session, Console& console) {
  std::vector<Line> lines;
  for (const char* scene : kScenes) {
    const v1::SceneSource source = GallerySource(scene);
    v1::Settings settings;
    settings.set_method(v1::Settings::EXACT);
    const auto truth = RenderFirstProbe(session, source, settings);
    if (!truth.ok()) return session.Explain(truth.status());
    settings.set_method(v1::Settings::IRRADIANCE_CACHING);
    for (std::uint32_t degree = 0; degree < kDegrees; ++degree) {
      for (int control = v1::Settings::SPLIT_SPHERE; control <= v1::Settings::VISIBILITY_EVENTS; ++control) {
        settings.set_error_control(static_cast<v1::Settings::ErrorControl>(control));
        settings.set_extrapolation(degree);
        Line& line = lines.emplace_back();
        line.scene = scene, line.degree = degree, line.control = OptionName(settings.error_control());
        console.ShowLine(line.scene + ", degree " + std::to_string(degree) + ", " + line.control);
        for (const std::uint32_t budget : kBudgets) {
          settings.set_max_records(budget);
          const auto found = RenderFirstProbe(session, source, settings);
          if (!found.ok()) return session.Explain(found.status());
          const auto comparison = Compare(*found, *truth, 1.0);
          if (!comparison.ok()) return comparison.status();
          line.points.emplace_back(found->records_size(), *comparison->quantities.front().relative_rms);
        }
      }
    }
  }
  console.EndProgress();
  return lines;
}

std::string Table(const std::vector<Line>& lines) {
  std::vector<std::vector<std::string>> rows = {{"SCENE", "ERROR CONTROL", "DEGREE 0", "DEGREE 1", "DEGREE 2"}};
  const std::size_t controls = lines.size() / kScenes.size() / kDegrees;
  for (std::size_t s = 0; s < kScenes.size(); ++s) {
    for (std::size_t c = 0; c < controls; ++c) {
      std::vector<std::string> row = {kScenes[s], lines[s * kDegrees * controls + c].control};
      for (std::size_t d = 0; d < kDegrees; ++d)
        row.push_back(FormatValue(lines[(s * kDegrees + d) * controls + c].ErrorWith(kShown), 2));
      rows.push_back(row);
    }
  }
  return FormatTable(rows);
}

std::string Csv(const std::vector<Line>& lines) {
  std::string text = "scene,degree,errorControl,records,relativeRmsError\n";
  for (const Line& line : lines)
    for (const auto& [records, error] : line.points)
      text += line.scene + ',' + std::to_string(line.degree) + ',' + line.control + ',' + FormatExactly(records) + ',' +
              FormatExactly(error) + '\n';
  return text;
}

std::string Script(const std::vector<Line>& lines, PlotForm form) {
  std::string script = PlotTerminal(form, 1000, 640), blocks;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    blocks += "$l" + std::to_string(i) + " << EOD\n";
    for (const auto& [records, error] : lines[i].points)
      blocks += FormatExactly(records) + ' ' + FormatExactly(error) + '\n';
    blocks += "EOD\n";
  }
  script +=
      blocks +
      "set encoding utf8\nset logscale xy\nset xrange [3.5:75]\nset yrange [1e-14:1]\nset format y '10^{%T}'\n"
      "set xtics (4, 8, 16, 32, 64)\nset tics nomirror textcolor rgb '#404040'\nset border 3 linecolor rgb '#404040'\n"
      "set grid linetype 1 linecolor rgb '#e4e4e4'\nunset key\n"
      "set multiplot layout 2,3 margins 0.07,0.985,0.17,0.94 spacing 0.05,0.1\n";
  const std::size_t controls = lines.size() / kScenes.size() / kDegrees;
  // A key would be no wider than its panel.
  for (std::size_t c = 0; c < controls; ++c)
    script += "set label " + std::to_string(c + 1) + " " + PlotText("● " + lines[c].control) + " at screen " +
              FormatValue(0.12 + 0.3 * static_cast<double>(c % 3), 4) + ", screen " + (c < 3 ? "0.055" : "0.02") +
              " textcolor rgb '" + kPlotColours[c] + "'\n";
  for (std::size_t panel = 0; panel < kScenes.size() * kDegrees; ++panel) {
    const Line& first = lines[panel * controls];
    script += "set title " + PlotText(first.scene + ", degree " + std::to_string(first.degree)) + "\n";
    script += panel >= kDegrees ? "set xlabel 'records'\n" : "unset xlabel\n";
    script += panel % kDegrees == 0 ? "set ylabel 'relative RMS error'\n" : "unset ylabel\n";
    std::string plots;
    for (std::size_t c = 0; c < controls; ++c)
      plots += ", $l" + std::to_string(panel * controls + c) +
               " using 1:2 with linespoints pointtype 7 pointsize 0.45 linewidth 1.6 linecolor rgb '" +
               kPlotColours[c] + "' notitle";
    script += "plot " + plots.substr(2) + "\n";
  }
  return script + "unset multiplot\n";
}

absl::Status Write(const std::vector<Line>& lines, const Output& output) {
  if (output.form == OutputForm::kCsv) return WriteFileAtomically(output.path, Csv(lines));
  const auto picture = RunGnuplot(Script(lines, output.form == OutputForm::kSvg ? PlotForm::kSvg : PlotForm::kPng));
  if (!picture.ok()) return OutputError(output.path, std::string(picture.status().message()));
  return WriteFileAtomically(output.path, *picture);
}

}  // namespace

CommandResult DrawRecordErrors(const CommandLine& line, Interruption& interruption) {
  const auto outputs = PlanOutputs(line.outputs);
  if (!outputs.ok()) return outputs.status();
  if (line.json) return UsageError("--json: " + line.figure + " has a table alone: use -o FILE.csv");
  for (const Output& output : *outputs) {
    if (output.path == "-" ||
        (output.form != OutputForm::kCsv && output.form != OutputForm::kSvg && output.form != OutputForm::kPng))
      return UsageError("--output: " + output.path + "; " + line.figure + " is written as .csv, .svg or .png");
  }
  Console console(Console::Answer::kText, line.quiet);
  const auto session = Session::Open(line, Session::WithoutServer::kStartOne, interruption);
  if (!session.ok()) return session.status();
  const auto lines = Measure(**session, console);
  if (!lines.ok()) return lines.status();
  console.Say(line.figure + ": relative RMS error of direct light from " + std::to_string(kShown) + " records\n\n" +
              Table(*lines));
  std::string written;
  for (const Output& output : *outputs) {
    if (absl::Status status = Write(*lines, output); !status.ok()) return status;
    written += (written.empty() ? "wrote " : ", ") + Printable(output.path);
  }
  console.Say(written.empty() ? "nothing written; -o errors.csv or errors.svg keeps the figure\n" : written + '\n');
  return ExitCode::kDone;
}

}  // namespace flatlight
