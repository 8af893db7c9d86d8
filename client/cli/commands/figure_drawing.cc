// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/figure_drawing.h"

#include "client/cli/commands/await_result.h"
#include "client/cli/commands/result_outputs.h"
#include "client/cli/jobs/job_calls.h"
#include "client/cli/text/numbers.h"

namespace flatlight {

absl::StatusOr<v1::RenderResult> FigureDrawing::RenderFirstProbe(const v1::SceneSource& source,
                                                                 const v1::Settings& settings) const {
  auto result = flatlight::RenderFirstProbe(session, source, settings);
  if (!result.ok()) return session.Explain(result.status());
  return result;
}

CommandResult FigureDrawing::Deliver(const std::string& text, const v1::RenderResult& result) const {
  console.Say(text);
  if (absl::Status written = WriteResult(result, outputs, console, interruption); !written.ok()) return written;
  return ExitCode::kDone;
}

CommandResult OpenAndDraw(const CommandLine& line, Interruption& interruption,
                          const std::function<CommandResult(const FigureDrawing&)>& draw) {
  const auto outputs = OutputsOf(line.outputs, line.json);
  if (!outputs.ok()) return outputs.status();
  Console console = ConsoleFor(*outputs, line.quiet);
  const auto session = Session::Open(line, Session::WithoutServer::kStartOne, interruption);
  if (!session.ok()) return session.status();
  return draw({line, *outputs, **session, console, interruption});
}

v1::SceneSource GallerySource(const std::string& name) {
  v1::SceneSource source;
  source.set_name("scenes/" + name);
  return source;
}

absl::StatusOr<v1::RenderResult> RenderFirstProbe(Session& session, const v1::SceneSource& source,
                                                  const v1::Settings& settings) {
  Console silent(Console::Answer::kMachine, true);
  const auto job = CreateJob(session.connection(), source, settings);
  if (!job.ok()) return job.status();
  auto result = AwaitResult(session, *job, /*cancel_on_disconnect=*/false, silent);
  if (!result.ok()) return result.status();
  result->mutable_probes()->DeleteSubrange(1, result->probes_size() - 1);
  return result;
}

void MakeCommon(const std::string& name, v1::RenderResult& result) {
  result.set_scene(name);
  result.clear_settings();
  result.clear_plan();
  result.clear_statistics();
  result.clear_records_seal();
}

std::string Share(const std::optional<double>& relative) { return relative ? FormatPercent(*relative) : "-"; }

}  // namespace flatlight
