// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/running/bench_job.h"

#include "client/cli/jobs/job_calls.h"
#include "client/cli/jobs/watch.h"
#include "client/cli/status/exit_code.h"

namespace flatlight {

absl::StatusOr<v1::RenderResult> RunBenchJob(Connection& connection, const v1::SceneSource& source,
                                             const v1::Settings& settings, const BenchJobHooks& hooks) {
  const auto job = CreateJob(connection, source, settings, {.anew = true});
  if (!job.ok()) return job.status();
  WatchOptions options;
  options.max_rate = 1;  // What is sent while a job runs disturbs it.
  options.on_update = hooks.on_update;
  options.check_server = hooks.check_server;
  const auto ended = WatchJob(connection, job->name(), options);
  if (!ended.ok()) {
    CancelJob(connection, job->name()).IgnoreError();
    return connection.interruption().Requested() ? InterruptedError("interrupted") : ended.status();
  }
  if (absl::Status success = CheckSuccess(*ended); !success.ok()) return success;
  auto result = FetchResult(connection, job->name());
  DeleteJob(connection, job->name()).IgnoreError();
  return result;
}

}  // namespace flatlight
