// SPDX-License-Identifier: Apache-2.0
// The runs of a benchmark, one at a time, in an order that is fair to all.
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_RUNNING_RUNNER_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_RUNNING_RUNNER_H_

#include <functional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/bench/rows/bench_row.h"
#include "client/cli/bench/running/subject.h"

namespace flatlight {

struct RunnerHooks {
  std::function<absl::Status(const BenchRow&)> keep;     // A run has ended.
  std::function<absl::Status(const std::string&)> show;  // How far it is; an error ends the benchmark.
  std::function<absl::Status()> check_server;            // As in WatchOptions.
};

struct RunnerReport {
  int done = 0;                       // Runs of this time.
  int before = 0;                     // Runs that were there already.
  std::vector<std::string> left_out;  // What the time limit did not allow, a line each.
};

// The machine and builds that every row names.
BenchRow RowContext(const Connection& connection, const std::string& client_build, const std::string& server_build);

// Does the runs that are not among `rows`. In the first round the methods climb their budgets side by side, as far as
// the time limit allows for all rounds; every later round goes through them once more, with another seed or repeat.
// A method that has runs to do is warmed up by one that does not count. `context` is what RowContext gives, with
// threads.
absl::StatusOr<RunnerReport> RunBench(Connection& connection, const std::vector<Subject>& subjects,
                                      const BenchOptions& options, std::uint32_t base_seed, const BenchRow& context,
                                      const std::vector<BenchRow>& rows, const RunnerHooks& hooks);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_RUNNING_RUNNER_H_
