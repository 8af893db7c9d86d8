// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "client/cli/bench/report/bench_text.h"
#include "client/cli/bench/rows/row_file.h"
#include "client/cli/bench/running/runner.h"
#include "client/cli/commands/bench_outputs.h"
#include "client/cli/commands/commands.h"
#include "client/cli/commands/console.h"
#include "client/cli/commands/session.h"
#include "client/cli/jobs/job_name.h"
#include "client/cli/jobs/watch.h"
#include "client/cli/outputs/outputs.h"
#include "client/cli/scenes/scene_file.h"
#include "client/cli/scenes/scene_upload.h"
#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

constexpr std::uint64_t kMostProgramBytes = 1U << 30;

std::string Message(const absl::Status& status) {
  return std::string(status.message().data(), status.message().size());
}

// The version, and of a program at hand its hash: an edited tree has builds without number of one commit.
std::string BuildOf(const std::string& version, const std::string& program, const Interruption& interruption) {
  const auto bytes = ReadFile(program, program, kMostProgramBytes, interruption);
  return bytes.ok() ? version + " (" + Sha256Hex(*bytes).substr(0, 8) + ")" : version;
}

// Why rows that are there cannot stand beside those to come; empty if they can.
std::string OtherSettings(const BenchRow& row, const std::vector<Subject>& subjects) {
  for (const Subject& subject : subjects) {
    if (row.scene_hash != subject.hash) {
      if (row.scene == subject.argument.label) return row.scene + " was another scene then (sceneHash)";
      continue;
    }
    for (const BenchMethod& method : subject.methods) {
      if (row.method != method.name) continue;
      if (row.settings != method.text)
        return "settings of " + row.scene + ' ' + row.method + " are " + row.settings + ", not " + method.text;
      if (row.truth != subject.truth.name)
        return "the truth of " + row.scene + " is " + row.truth + ", not " + subject.truth.name;
    }
  }
  return "";
}

bool Fits(const BenchRow& row, const BenchRow& context, const std::vector<Subject>& subjects) {
  return OtherContext(row, context).empty() && OtherSettings(row, subjects).empty();
}

absl::Status CheckRows(const RowFile& file, const BenchRow& context, const std::vector<Subject>& subjects) {
  for (const BenchRow& row : file.rows()) {
    std::string reason = OtherContext(row, context);
    if (reason.empty()) reason = OtherSettings(row, subjects);
    if (!reason.empty())
      return UsageError(
          Printable(file.path()) + " holds other runs: " + reason +
          "; name another file, or give --force to go on in this one (its other rows then count for nothing)");
  }
  return absl::OkStatus();
}

absl::Status CheckScenes(const BenchOptions& options) {
  if (options.scenes.empty() && !options.gallery) return UsageError("bench: a SCENE or --gallery is needed");
  for (const std::string& text : options.scenes) {
    const auto scene = ParseSceneArgument(text);
    if (!scene.ok()) return scene.status();
    if (absl::Status readable = CheckSceneFile(*scene); !readable.ok()) return readable;
  }
  return absl::OkStatus();
}

// Others' jobs on the server make times longer.
std::string BusyNote(Session& session) {
  if (session.is_private()) return "";
  const auto jobs = ListJobs(session.connection());
  if (!jobs.ok()) return "";
  const auto active = std::count_if(jobs->begin(), jobs->end(), [](const v1::Job& job) {
    return !HasEnded(job.state()) && job.state() != v1::Job::PAUSED;
  });
  return active == 0 ? ""
                     : "note: the server has other jobs to do (" + std::to_string(active) + "): times will be noisy\n";
}

class Bench {
 public:
  Bench(const CommandLine& line, BenchOutputs outputs, Session& session, Interruption& interruption, Console& console)
      : line_(line), outputs_(std::move(outputs)), session_(session), interruption_(interruption), console_(console) {}

  absl::Status Run() {
    if (!outputs_.csv.empty()) {
      auto file = RowFile::Open(outputs_.csv);
      if (!file.ok()) return file.status();
      file_ = *std::move(file);
    }
    auto subjects = PrepareSubjects(session_.connection(), line_.bench, line_.settings);
    if (!subjects.ok()) return session_.Explain(subjects.status());
    subjects_ = *std::move(subjects);
    context_ =
        RowContext(session_.connection(), BuildOf(line_.version, "/proc/self/exe", interruption_), ServerBuild());
    context_.threads = subjects_.subjects[0].methods[0].threads;
    if (file_ != nullptr) {
      if (!line_.bench.force)
        if (absl::Status fits = CheckRows(*file_, context_, subjects_.subjects); !fits.ok()) return fits;
      for (const BenchRow& row : file_->rows())
        if (Fits(row, context_, subjects_.subjects)) rows_.push_back(row);
    }
    for (const std::string& note : subjects_.notes) console_.Say("note: " + Printable(note) + '\n');
    console_.Say(BusyNote(session_));
    if (absl::Status measured = MeasureAll(); !measured.ok()) return measured;
    return Report();
  }

 private:
  std::string ServerBuild() const {
    const std::string& version = session_.connection().capabilities().version();
    return session_.is_private() ? BuildOf(version, session_.server_program(), interruption_) : version;
  }

  absl::Status MeasureAll() {
    RunnerHooks hooks;
    hooks.keep = [this](const BenchRow& row) {
      rows_.push_back(row);
      return file_ == nullptr ? absl::OkStatus() : file_->Append(row);
    };
    hooks.show = [this](const std::string& text) {
      console_.ShowLine(text);
      return console_.status();
    };
    hooks.check_server = [this] { return session_.CheckServer(); };
    const std::vector<BenchRow> before = rows_;
    const auto report = RunBench(session_.connection(), subjects_.subjects, line_.bench, line_.settings.seed(),
                                 context_, before, hooks);
    console_.EndProgress();
    if (!report.ok()) return Kept(session_.Explain(report.status()), rows_.size() - before.size());
    std::string text = Plural(report->done, "run");
    if (report->before > 0) text += "; " + std::to_string(report->before) + " there already";
    console_.Say(text + '\n');
    for (const std::string& left : report->left_out) console_.Say("left out   " + Printable(left) + '\n');
    return console_.status();
  }

  // What ended the benchmark, and what is left of it.
  absl::Status Kept(const absl::Status& status, std::size_t done) const {
    if (file_ == nullptr || done == 0) return status;
    return absl::Status(status.code(), Message(status) + "; " + Plural(static_cast<double>(done), "run") + " more in " +
                                           Printable(outputs_.csv) + ", where the same command goes on");
  }

  absl::Status Report() {
    const std::vector<Curve> curves = CurvesOf(rows_);
    if (!outputs_.ToStandardOutput()) console_.Say('\n' + BenchText(curves, rows_));
    if (absl::Status written = WriteBenchOutputs(outputs_, curves, rows_); !written.ok()) return written;
    console_.Say(BenchWrittenText(outputs_));
    return console_.status();
  }

  const CommandLine& line_;
  const BenchOutputs outputs_;
  Session& session_;
  Interruption& interruption_;
  Console& console_;
  std::unique_ptr<RowFile> file_;
  Subjects subjects_;
  BenchRow context_;
  std::vector<BenchRow> rows_;  // That count: of this machine, build and settings.
};

}  // namespace

CommandResult BenchMethods(const CommandLine& line, Interruption& interruption) {
  if (absl::Status scenes = CheckScenes(line.bench); !scenes.ok()) return scenes;
  auto outputs = PlanBenchOutputs(line.outputs, line.json);
  if (!outputs.ok()) return outputs.status();
  Console console(outputs->ToStandardOutput() ? Console::Answer::kMachine : Console::Answer::kText, line.quiet);
  const auto session = Session::Open(line, Session::WithoutServer::kStartOne, interruption);
  if (!session.ok()) return session.status();
  const absl::Status done = Bench(line, *std::move(outputs), **session, interruption, console).Run();
  if (!done.ok()) return done;
  return ExitCode::kDone;
}

}  // namespace flatlight
