// SPDX-License-Identifier: Apache-2.0
#include "client/cli/outputs/outputs.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "client/cli/formats/csv.h"
#include "client/cli/formats/gnuplot.h"
#include "client/cli/formats/json_text.h"
#include "client/cli/formats/npy.h"
#include "client/cli/formats/plot_script.h"
#include "client/cli/formats/plot_series.h"
#include "client/cli/outputs/atomic_file.h"
#include "client/cli/outputs/picture_writer.h"
#include "client/cli/outputs/tone_mapping.h"
#include "client/cli/status/exit_code.h"

namespace flatlight {
namespace {

constexpr std::array<std::pair<const char*, OutputForm>, 7> kForms = {{{".json", OutputForm::kJson},
                                                                       {".csv", OutputForm::kCsv},
                                                                       {".npy", OutputForm::kNpy},
                                                                       {".svg", OutputForm::kSvg},
                                                                       {".png", OutputForm::kPng},
                                                                       {".exr", OutputForm::kExr},
                                                                       {".hdr", OutputForm::kHdr}}};

std::string Reason(const absl::Status& status) { return std::string(status.message().data(), status.message().size()); }

absl::StatusOr<OutputForm> FormOf(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  for (const auto& [known, form] : kForms)
    if (ending == known) return form;
  return UsageError("--output: " + path + (ending.empty() ? " has no ending" : " has an unknown ending") +
                    "; must end in one of " + OutputEndings() + ", or be - for JSON on standard output");
}

bool IsPlot(OutputForm form) { return form == OutputForm::kSvg || form == OutputForm::kPng; }
bool IsPictureForm(OutputForm form) { return form == OutputForm::kExr || form == OutputForm::kHdr; }

absl::Status CheckOutput(const Output& output) {
  absl::Status tool = absl::OkStatus();
  if (IsPlot(output.form)) tool = FindGnuplot();
  // What .png shows is known when the result is: pictures if there are any.
  if (tool.ok() && (IsPictureForm(output.form) || output.form == OutputForm::kPng)) tool = FindPictureModule();
  if (!tool.ok()) return OutputError(output.path, Reason(tool));
  return CheckWritable(output.path);
}

absl::StatusOr<std::string> Pictures(const v1::RenderResult& result, const std::string& ending) {
  std::vector<Picture> pictures = PicturesOf(result);
  if (pictures.empty()) return absl::FailedPreconditionError("the result has no points");
  if (ending == ".hdr") pictures = {StackedColour(pictures)};
  return PictureBytes(ending, pictures);
}

// Of pictures and cameras alone, as a screen shows them.
absl::StatusOr<std::string> ScreenPicture(const v1::RenderResult& result) {
  v1::RenderResult shown;
  for (const v1::ProbeResult& probe : result.probes())
    if (probe.has_width()) *shown.add_probes() = probe;
  std::vector<Picture> pictures = PicturesOf(shown);
  for (Picture& picture : pictures)
    if (picture.height == 1) picture = Strip(picture);
  return PictureBytes(".png", {ToneMapped(StackedColour(pictures))});
}

absl::StatusOr<std::string> Plot(const v1::RenderResult& result, PlotForm form) {
  const auto plottable = [](const v1::ProbeResult& probe) { return !IsPicture(probe); };
  if (!std::any_of(result.probes().begin(), result.probes().end(), plottable) && result.probes_size() > 0)
    return absl::FailedPreconditionError("the result is a picture, not a curve to plot: use .png, .exr or .hdr");
  return RunGnuplot(PlotScript(result, form));
}

absl::StatusOr<std::string> Bytes(const v1::RenderResult& result, OutputForm form,
                                  const std::function<bool()>& interrupted) {
  switch (form) {
    case OutputForm::kCsv:
      return ResultToCsv(result, interrupted);
    case OutputForm::kNpy:
      return ResultToNpy(result, interrupted);
    case OutputForm::kSvg:
      return Plot(result, PlotForm::kSvg);
    case OutputForm::kPng:
      return HasPictures(result) ? ScreenPicture(result) : Plot(result, PlotForm::kPng);
    case OutputForm::kExr:
      return Pictures(result, ".exr");
    case OutputForm::kHdr:
      return Pictures(result, ".hdr");
    default:
      return ToJson(result);
  }
}

absl::Status WriteOutput(const v1::RenderResult& result, const Output& output,
                         const std::function<bool()>& interrupted) {
  absl::Status stopped = InterruptedError("interrupted before " + output.path + " was written");
  if (interrupted()) return stopped;
  const absl::StatusOr<std::string> bytes = Bytes(result, output.form, interrupted);
  if (interrupted()) return stopped;
  if (!bytes.ok()) return OutputError(output.path, Reason(bytes.status()));
  return output.path == "-" ? PrintBytes(*bytes) : WriteFileAtomically(output.path, *bytes);
}

}  // namespace

std::string OutputEndings() {
  std::string endings;
  for (const auto& [ending, form] : kForms) endings += (endings.empty() ? "" : " ") + std::string(ending);
  return endings;
}

absl::StatusOr<std::vector<Output>> PlanOutputs(const std::vector<std::string>& paths) {
  std::vector<Output> outputs;
  for (const std::string& path : paths) {
    const auto same = [&path](const Output& output) { return output.path == path; };
    if (std::any_of(outputs.begin(), outputs.end(), same)) return UsageError("--output: " + path + " is given twice");
    if (path == "-") {
      outputs.push_back({path, OutputForm::kJson});
      continue;
    }
    const absl::StatusOr<OutputForm> form = FormOf(path);
    if (!form.ok()) return form.status();
    outputs.push_back({path, *form});
  }
  for (const Output& output : outputs) {
    if (output.path == "-") continue;
    if (absl::Status status = CheckOutput(output); !status.ok()) return status;
  }
  return outputs;
}

bool WritesToStandardOutput(const std::vector<Output>& outputs) {
  return std::any_of(outputs.begin(), outputs.end(), [](const Output& output) { return output.path == "-"; });
}

absl::Status WriteOutputs(const v1::RenderResult& result, const std::vector<Output>& outputs,
                          const std::function<bool()>& interrupted) {
  std::string failures;
  for (const Output& output : outputs) {
    const absl::Status status = WriteOutput(result, output, interrupted);
    if (status.code() == absl::StatusCode::kCancelled)
      return InterruptedError(failures + (failures.empty() ? "" : "\n") + Reason(status));
    if (!status.ok()) failures += (failures.empty() ? "" : "\n") + Reason(status);
  }
  return failures.empty() ? absl::OkStatus() : absl::DataLossError(failures);
}

absl::Status PrintBytes(const std::string& bytes) {
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() && std::fflush(stdout) == 0;
  return written ? absl::OkStatus() : OutputError("standard output", std::strerror(errno));
}

}  // namespace flatlight
