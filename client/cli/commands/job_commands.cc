// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/commands/console.h"
#include "client/cli/commands/job_text.h"
#include "client/cli/commands/plan_text.h"
#include "client/cli/commands/result_input.h"
#include "client/cli/commands/result_outputs.h"
#include "client/cli/commands/session.h"
#include "client/cli/formats/enum_names.h"
#include "client/cli/formats/json_text.h"
#include "client/cli/formats/timestamp.h"
#include "client/cli/jobs/job_calls.h"
#include "client/cli/jobs/job_name.h"
#include "client/cli/jobs/watch.h"
#include "client/cli/outputs/outputs.h"
#include "client/cli/scenes/scene_upload.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

absl::StatusOr<std::unique_ptr<Session>> OpenServer(const CommandLine& line, Interruption& interruption) {
  return Session::Open(line, Session::WithoutServer::kRefuse, interruption);
}

// Prints the job as `act` leaves it.
CommandResult Control(const CommandLine& line, Interruption& interruption,
                      absl::StatusOr<v1::Job> (*act)(Connection&, const std::string&)) {
  const auto session = OpenServer(line, interruption);
  if (!session.ok()) return session.status();
  const auto name = ResolveJobName((*session)->connection(), line.job);
  if (!name.ok()) return name.status();
  const auto job = act((*session)->connection(), *name);
  if (!job.ok()) return job.status();
  if (line.json) return Answer(ToJson(*job));
  return line.quiet ? ExitCode::kDone : Answer(job->name() + " " + OptionName(job->state()) + '\n');
}

// Deletes the jobs that ended longer ago, here and on the server.
absl::Status Prune(Connection& connection, double seconds, std::vector<v1::Job>& jobs) {
  const double now = SecondsNow();
  std::vector<v1::Job> kept;
  for (v1::Job& job : jobs) {
    if (!job.has_end_time() || now - SecondsOf(job.end_time()) < seconds) {
      kept.push_back(std::move(job));
      continue;
    }
    absl::Status deleted = DeleteJob(connection, job.name());
    if (!deleted.ok() && !absl::IsNotFound(deleted)) return deleted;
  }
  jobs = std::move(kept);
  return absl::OkStatus();
}

}  // namespace

CommandResult Submit(const CommandLine& line, Interruption& interruption) {
  const auto scene = ParseSceneArgument(line.scene);
  if (!scene.ok()) return scene.status();
  if (absl::Status readable = CheckSceneFile(*scene); !readable.ok()) return readable;
  const auto records = ReadKnownRecords(line.known_records, interruption);
  if (!records.ok()) return records.status();
  const auto session = OpenServer(line, interruption);
  if (!session.ok()) return session.status();
  Connection& connection = (*session)->connection();
  const auto source = ProvideScene(connection, *scene, line.probes);
  if (!source.ok()) return source.status();
  const auto job =
      CreateJob(connection, *source, line.settings,
                {.job_class = line.job_class, .records = *records, .anew = line.anew, .webhook = line.webhook});
  if (!job.ok())
    return ExplainSceneError(connection, *scene, *source, ExplainRecordsError(line.known_records, job.status()));
  Console console(Console::Answer::kMachine, line.quiet);
  console.Say("scene     " + Printable(job->scene()) + " (" + scene->label + ")\n" + ShortPlanText(job->plan()));
  return Answer(line.json ? ToJson(*job) : job->name() + '\n');
}

CommandResult Watch(const CommandLine& line, Interruption& interruption) {
  const auto session = OpenServer(line, interruption);
  if (!session.ok()) return session.status();
  Connection& connection = (*session)->connection();
  const auto name = ResolveJobName(connection, line.job);
  if (!name.ok()) return name.status();
  Console console(line.json || line.records ? Console::Answer::kMachine : Console::Answer::kText, line.quiet);
  WatchOptions options;
  options.max_rate = console.Rate();
  options.cancel_on_disconnect = line.cancel_on_disconnect;
  if (line.records) {
    options.max_rate = 20;
    options.on_record = [](std::uint32_t, const v1::CacheRecord& record) { return PrintBytes(ToJsonLine(record)); };
  }
  options.on_update = [&console](const v1::Job& job) {
    console.Show(job);
    return console.status();
  };
  const auto job = WatchJob(connection, *name, options);
  console.EndProgress();
  if (!job.ok() && interruption.Requested()) {
    return InterruptedError("stopped watching; " + (line.cancel_on_disconnect
                                                        ? *name + " is cancelled"
                                                        : "the job goes on (flatlight cancel " + *name + " stops it)"));
  }
  if (!job.ok()) return job.status();
  if (line.json)
    if (absl::Status printed = PrintBytes(ToJson(*job)); !printed.ok()) return printed;
  if (absl::Status success = CheckSuccess(*job); !success.ok()) return success;
  const std::string reason = job->end_reason() == 0 ? "" : " (" + OptionName(job->end_reason()) + ")";
  console.Say(job->name() + " " + OptionName(job->state()) + reason + '\n');
  if (absl::Status said = console.status(); !said.ok()) return said;
  return ExitCode::kDone;
}

CommandResult Jobs(const CommandLine& line, Interruption& interruption) {
  const auto session = OpenServer(line, interruption);
  if (!session.ok()) return session.status();
  const WhoseJobs whose = line.shared                       ? WhoseJobs::kShared
                          : line.mine || line.prune_seconds ? WhoseJobs::kOwn
                                                            : WhoseJobs::kAll;
  auto jobs = ListJobs((*session)->connection(), whose);
  if (!jobs.ok()) return jobs.status();
  if (line.prune_seconds) {
    absl::Status pruned = Prune((*session)->connection(), *line.prune_seconds, *jobs);
    if (!pruned.ok()) return pruned;
  }
  if (line.json) {
    v1::ListJobsResponse all;
    all.mutable_jobs()->Add(jobs->begin(), jobs->end());
    return Answer(ToJson(all));
  }
  return Answer(JobListText(*jobs, SecondsNow(), whose));
}

CommandResult Show(const CommandLine& line, Interruption& interruption) {
  const auto session = OpenServer(line, interruption);
  if (!session.ok()) return session.status();
  const auto name = ResolveJobName((*session)->connection(), line.job);
  if (!name.ok()) return name.status();
  const auto job = GetJob((*session)->connection(), *name);
  if (!job.ok()) return job.status();
  return Answer(line.json ? ToJson(*job) : JobText(*job));
}

CommandResult Fetch(const CommandLine& line, Interruption& interruption) {
  const auto outputs = OutputsOf(line.outputs, line.json);
  if (!outputs.ok()) return outputs.status();
  const auto session = OpenServer(line, interruption);
  if (!session.ok()) return session.status();
  const auto name = ResolveJobName((*session)->connection(), line.job);
  if (!name.ok()) return name.status();
  const auto result = FetchResult((*session)->connection(), *name);
  if (!result.ok()) return result.status();
  Console console = ConsoleFor(*outputs, line.quiet);
  if (absl::Status delivered = DeliverResult(*result, *outputs, console, interruption); !delivered.ok())
    return delivered;
  return ExitCode::kDone;
}

CommandResult Cancel(const CommandLine& line, Interruption& interruption) {
  return Control(line, interruption, CancelJob);
}

CommandResult Pause(const CommandLine& line, Interruption& interruption) {
  return Control(line, interruption, PauseJob);
}

CommandResult Resume(const CommandLine& line, Interruption& interruption) {
  return Control(line, interruption, ResumeJob);
}

}  // namespace flatlight
