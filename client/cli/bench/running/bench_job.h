// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_RUNNING_BENCH_JOB_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_RUNNING_BENCH_JOB_H_

#include <functional>

#include "absl/status/statusor.h"
#include "client/cli/connection/connection.h"

namespace flatlight {

struct BenchJobHooks {
  std::function<absl::Status(const v1::Job&)> on_update;  // An error ends the benchmark.
  std::function<absl::Status()> check_server;             // As in WatchOptions.
};

// Runs a job to its end and gives its result; the server does not keep it. After a signal, and after an error of
// on_update, the job is cancelled.
absl::StatusOr<v1::RenderResult> RunBenchJob(Connection& connection, const v1::SceneSource& source,
                                             const v1::Settings& settings, const BenchJobHooks& hooks);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_RUNNING_BENCH_JOB_H_
