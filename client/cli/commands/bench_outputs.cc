// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/bench_outputs.h"

#include <algorithm>
#include <set>

#include "client/cli/bench/report/bench_json.h"
#include "client/cli/bench/report/error_plot.h"
#include "client/cli/formats/gnuplot.h"
#include "client/cli/outputs/atomic_file.h"
#include "client/cli/outputs/outputs.h"
#include "client/cli/status/exit_code.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

std::string Reason(const absl::Status& status) { return std::string(status.message().data(), status.message().size()); }

bool EndsWith(const std::string& path, const std::string& ending) {
  if (path.size() <= ending.size()) return false;
  return std::equal(ending.begin(), ending.end(), path.end() - static_cast<std::ptrdiff_t>(ending.size()),
                    [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b); });
}

absl::Status Place(const std::string& path, BenchOutputs& outputs) {
  if (path == "-" || EndsWith(path, ".json")) {
    outputs.reports.push_back(path);
  } else if (EndsWith(path, ".svg") || EndsWith(path, ".png")) {
    outputs.pictures.push_back(path);
    if (absl::Status tool = FindGnuplot(); !tool.ok()) return OutputError(path, Reason(tool));
  } else if (EndsWith(path, ".csv")) {
    if (!outputs.csv.empty()) return UsageError("--output: " + path + " is a second .csv; the runs go into one");
    outputs.csv = path;
  } else {
    return UsageError("--output: " + path + " has no known ending; must end in one of .csv .svg .png .json, or be -" +
                      " for JSON on standard output");
  }
  return path == "-" ? absl::OkStatus() : CheckWritable(path);
}

absl::StatusOr<std::string> Picture(const std::vector<Curve>& curves, const std::string& path) {
  return RunGnuplot(ErrorPlotScript(curves, EndsWith(path, ".svg") ? PlotForm::kSvg : PlotForm::kPng));
}

}  // namespace

bool BenchOutputs::ToStandardOutput() const { return std::find(reports.begin(), reports.end(), "-") != reports.end(); }

absl::StatusOr<BenchOutputs> PlanBenchOutputs(const std::vector<std::string>& paths, bool json) {
  BenchOutputs outputs;
  std::set<std::string> seen;
  for (const std::string& path : paths) {
    if (!seen.insert(path).second) return UsageError("--output: " + path + " is given twice");
    if (absl::Status placed = Place(path, outputs); !placed.ok()) return placed;
  }
  if (json && !outputs.ToStandardOutput()) outputs.reports.emplace_back("-");
  return outputs;
}

absl::Status WriteBenchOutputs(const BenchOutputs& outputs, const std::vector<Curve>& curves,
                               const std::vector<BenchRow>& rows) {
  std::string failures;
  const auto note = [&failures](const absl::Status& status) {
    if (!status.ok()) failures += (failures.empty() ? "" : "\n") + Reason(status);
  };
  for (const std::string& path : outputs.pictures) {
    const absl::StatusOr<std::string> picture = Picture(curves, path);
    note(picture.ok() ? WriteFileAtomically(path, *picture) : OutputError(path, Reason(picture.status())));
  }
  for (const std::string& path : outputs.reports) {
    const std::string json = BenchJson(curves, rows);
    note(path == "-" ? PrintBytes(json) : WriteFileAtomically(path, json));
  }
  return failures.empty() ? absl::OkStatus() : absl::DataLossError(failures);
}

std::string BenchWrittenText(const BenchOutputs& outputs) {
  std::vector<std::string> paths = outputs.pictures;
  if (!outputs.csv.empty()) paths.insert(paths.begin(), outputs.csv);
  for (const std::string& path : outputs.reports)
    if (path != "-") paths.push_back(path);
  if (paths.empty() && !outputs.ToStandardOutput())
    return "nothing written; -o bench.csv keeps the runs, -o bench.svg draws them\n";
  std::string text;
  for (const std::string& path : paths) text += (text.empty() ? "wrote " : ", ") + Printable(path);
  return text.empty() ? "" : text + '\n';
}

}  // namespace flatlight
