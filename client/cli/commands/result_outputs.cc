// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/result_outputs.h"

#include "client/cli/commands/result_text.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

std::string WrittenText(const std::vector<Output>& outputs) {
  if (outputs.empty()) return "nothing written; -o result.json, .csv, .npy, .svg or .png keeps the result\n";
  std::string text;
  for (const Output& output : outputs)
    if (output.path != "-") text += (text.empty() ? "wrote " : ", ") + Printable(output.path);
  return text.empty() ? "" : text + '\n';
}

}  // namespace

absl::StatusOr<std::vector<Output>> OutputsOf(const std::vector<std::string>& paths, bool json) {
  absl::StatusOr<std::vector<Output>> outputs = PlanOutputs(paths);
  if (outputs.ok() && json && !WritesToStandardOutput(*outputs)) outputs->push_back({"-", OutputForm::kJson});
  return outputs;
}

Console ConsoleFor(const std::vector<Output>& outputs, bool quiet) {
  return {WritesToStandardOutput(outputs) ? Console::Answer::kMachine : Console::Answer::kText, quiet};
}

absl::Status DeliverResult(const v1::RenderResult& result, const std::vector<Output>& outputs, Console& console,
                           const Interruption& interruption) {
  console.Say(ResultText(result));
  return WriteResult(result, outputs, console, interruption);
}

absl::Status WriteResult(const v1::RenderResult& result, const std::vector<Output>& outputs, Console& console,
                         const Interruption& interruption) {
  const auto interrupted = [&interruption] { return interruption.Requested(); };
  if (absl::Status written = WriteOutputs(result, outputs, interrupted); !written.ok()) return written;
  console.Say(WrittenText(outputs));
  return console.status();
}

}  // namespace flatlight
