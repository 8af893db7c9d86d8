// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/commands/console.h"
#include "client/cli/commands/plan_text.h"
#include "client/cli/commands/result_outputs.h"
#include "client/cli/commands/session.h"
#include "client/cli/jobs/job_calls.h"
#include "client/cli/jobs/watch.h"
#include "client/cli/outputs/outputs.h"
#include "client/cli/scenes/scene_upload.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

// The user's Ctrl-C ends the job too.
absl::Status CancelAfterSignal(Session& session, const v1::Job& job) {
  const auto cancelled = CancelJob(session.connection(), job.name());
  if (!cancelled.ok())
    return InterruptedError("interrupted; " + job.name() + " could not be cancelled: " +
                            std::string(cancelled.status().message().data(), cancelled.status().message().size()));
  return InterruptedError("interrupted; " + (session.is_private() ? "the job" : job.name()) + " is cancelled");
}

// What is said finds no reader any more (`| head`): the job ends too. A private server stops it anyhow.
absl::Status CancelUnheard(Session& session, const v1::Job& job, const absl::Status& said) {
  const auto cancelled = CancelJob(session.connection(), job.name());
  if (cancelled.ok() || session.is_private()) return said;
  return absl::Status(said.code(), std::string(said.message().data(), said.message().size()) + "\n" + job.name() +
                                       " could not be cancelled: " + cancelled.status().ToString());
}

absl::StatusOr<v1::RenderResult> WaitForResult(Session& session, const v1::Job& job, Console& console) {
  WatchOptions options;
  options.max_rate = console.Rate();
  options.on_update = [&console](const v1::Job& update) {
    console.Show(update);
    return console.status();
  };
  options.check_server = [&session] { return session.CheckServer(); };
  const auto ended = WatchJob(session.connection(), job.name(), options);
  console.EndProgress();
  if (session.connection().interruption().Requested()) return CancelAfterSignal(session, job);
  if (absl::Status said = console.status(); !said.ok()) return CancelUnheard(session, job, said);
  if (!ended.ok()) return ended.status();
  if (absl::Status success = CheckSuccess(*ended); !success.ok()) return success;
  return FetchResult(session.connection(), job.name());
}

}  // namespace

CommandResult Render(const CommandLine& line, Interruption& interruption) {
  const auto outputs = OutputsOf(line.outputs, line.json);
  if (!outputs.ok()) return outputs.status();
  const auto scene = ParseSceneArgument(line.scene);
  if (!scene.ok()) return scene.status();
  if (absl::Status readable = CheckSceneFile(*scene); !readable.ok()) return readable;
  Console console = ConsoleFor(*outputs, line.quiet);

  const auto session = Session::Open(line, Session::WithoutServer::kStartOne, interruption);
  if (!session.ok()) return session.status();
  Connection& connection = (*session)->connection();
  const auto source = ProvideScene(connection, *scene, line.probes);
  if (!source.ok()) return (*session)->Explain(source.status());
  const auto job = CreateJob(connection, *source, line.settings);
  if (!job.ok()) return ExplainSceneError(connection, *scene, *source, (*session)->Explain(job.status()));
  console.Say("scene     " + Printable(job->scene()) + " (" + scene->label + ")\n" + ShortPlanText(job->plan()));
  if (!(*session)->is_private()) console.Say("job       " + job->name() + '\n');

  const auto result = WaitForResult(**session, *job, console);
  if (!result.ok()) return (*session)->Explain(result.status());
  if (absl::Status delivered = DeliverResult(*result, *outputs, console, interruption); !delivered.ok())
    return delivered;
  return ExitCode::kDone;
}

}  // namespace flatlight
