// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include "client/cli/bench/report/bench_json.h"
#include "client/cli/bench/report/versus_text.h"
#include "client/cli/bench/rows/row_reader.h"
#include "client/cli/commands/commands.h"
#include "client/cli/outputs/outputs.h"
#include "client/cli/scenes/scene_file.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

constexpr std::uint64_t kMostBytes = 1U << 30;

absl::StatusOr<std::vector<BenchRow>> ReadRows(const std::string& path, const Interruption& interruption) {
  const std::string label = path == "-" ? "standard input" : Printable(path);
  const auto bytes = ReadFile(path, label, kMostBytes, interruption);
  if (!bytes.ok()) return bytes.status();
  return RowsFromCsv(*bytes, label);
}

}  // namespace

CommandResult CompareBenchmarks(const CommandLine& line, Interruption& interruption) {
  const auto a = ReadRows(line.results[0], interruption);
  if (!a.ok()) return a.status();
  const auto b = ReadRows(line.results[1], interruption);
  if (!b.ok()) return b.status();
  VersusOptions options;
  options.least = line.bench.least;
  const auto versus = CompareBenches(*a, *b, options);
  if (!versus.ok()) return versus.status();
  if (line.json || !line.quiet) {
    const absl::Status printed = PrintBytes(line.json ? VersusJson(*versus) : VersusText(*versus, options));
    if (!printed.ok()) return printed;
  }
  return versus->SomethingIsWorse() ? ExitCode::kDiffers : ExitCode::kDone;
}

}  // namespace flatlight
