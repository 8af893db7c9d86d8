// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/await_result.h"

#include <string>

#include "client/cli/jobs/job_calls.h"
#include "client/cli/jobs/watch.h"
#include "client/cli/status/exit_code.h"

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

}  // namespace

absl::StatusOr<v1::RenderResult> AwaitResult(Session& session, const v1::Job& job, bool cancel_on_disconnect,
                                             Console& console) {
  WatchOptions options;
  options.cancel_on_disconnect = cancel_on_disconnect;
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

}  // namespace flatlight
