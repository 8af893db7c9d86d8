// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "client/cli/commands/await_result.h"
#include "client/cli/commands/commands.h"
#include "client/cli/commands/console.h"
#include "client/cli/commands/plan_text.h"
#include "client/cli/commands/result_input.h"
#include "client/cli/commands/result_outputs.h"
#include "client/cli/commands/session.h"
#include "client/cli/jobs/job_calls.h"
#include "client/cli/outputs/outputs.h"
#include "client/cli/scenes/scene_upload.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
CommandResult Render(const CommandLine& line, Interruption& interruption) {
  const auto outputs = OutputsOf(line.outputs, line.json);
  if (!outputs.ok()) return outputs.status();
  const auto scene = ParseSceneArgument(line.scene);
  if (!scene.ok()) return scene.status();
  if (absl::Status readable = CheckSceneFile(*scene); !readable.ok()) return readable;
  const auto records = ReadKnownRecords(line.known_records, interruption);
  if (!records.ok()) return records.status();
  Console console = ConsoleFor(*outputs, line.quiet);

  const auto session = Session::Open(line, Session::WithoutServer::kStartOne, interruption);
  if (!session.ok()) return session.status();
  Connection& connection = (*session)->connection();
  const auto source = ProvideScene(connection, *scene, line.probes);
  if (!source.ok()) return (*session)->Explain(source.status());
  const auto job = CreateJob(connection, *source, line.settings, {.records = *records, .anew = line.anew});
  if (!job.ok())
    return ExplainSceneError(connection, *scene, *source,
                             ExplainRecordsError(line.known_records, (*session)->Explain(job.status())));
  console.Say("scene     " + Printable(job->scene()) + " (" + scene->label + ")\n" + ShortPlanText(job->plan()));
  if (!(*session)->is_private()) console.Say("job       " + job->name() + '\n');

  const auto result = AwaitResult(**session, *job, line.cancel_on_disconnect, console);
  if (!result.ok()) return (*session)->Explain(result.status());
  if (absl::Status delivered = DeliverResult(*result, *outputs, console, interruption); !delivered.ok())
    return delivered;
  return ExitCode::kDone;
}

}  // namespace flatlight
