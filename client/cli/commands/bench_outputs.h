// SPDX-License-Identifier: Apache-2.0
// Where a benchmark goes: the files of -o, and standard output.
#ifndef FLATLIGHT_CLIENT_CLI_COMMANDS_BENCH_OUTPUTS_H_
#define FLATLIGHT_CLIENT_CLI_COMMANDS_BENCH_OUTPUTS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/bench/analysis/curve.h"

namespace flatlight {

struct BenchOutputs {
  std::string csv;                    // Empty if there is none.
  std::vector<std::string> pictures;  // .svg or .png.
  std::vector<std::string> reports;   // JSON; "-" is standard output.
  bool ToStandardOutput() const;
};

// The forms of the paths by their endings, checked before the work as PlanOutputs does; `json` adds "-".
absl::StatusOr<BenchOutputs> PlanBenchOutputs(const std::vector<std::string>& paths, bool json);

// Pictures and reports; the error has a line for each that could not be written.
absl::Status WriteBenchOutputs(const BenchOutputs& outputs, const std::vector<Curve>& curves,
                               const std::vector<BenchRow>& rows);

// "wrote bench.csv, bench.svg", or how to keep the benchmark.
std::string BenchWrittenText(const BenchOutputs& outputs);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMMANDS_BENCH_OUTPUTS_H_
