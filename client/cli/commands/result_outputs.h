// SPDX-License-Identifier: Apache-2.0
// What `render` and `fetch` do with a result.
#ifndef FLATLIGHT_CLIENT_CLI_COMMANDS_RESULT_OUTPUTS_H_
#define FLATLIGHT_CLIENT_CLI_COMMANDS_RESULT_OUTPUTS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/commands/console.h"
#include "client/cli/connection/interruption.h"
#include "client/cli/outputs/outputs.h"

namespace flatlight {

// The outputs of -o, and standard output if `json`, checked as PlanOutputs does.
absl::StatusOr<std::vector<Output>> OutputsOf(const std::vector<std::string>& paths, bool json);

// The console for a command that writes these.
Console ConsoleFor(const std::vector<Output>& outputs, bool quiet);

// Writes all outputs, unless interrupted, and says what was written.
absl::Status WriteResult(const v1::RenderResult& result, const std::vector<Output>& outputs, Console& console,
                         const Interruption& interruption);

// The same, and before it says what the result is like.
absl::Status DeliverResult(const v1::RenderResult& result, const std::vector<Output>& outputs, Console& console,
                           const Interruption& interruption);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMMANDS_RESULT_OUTPUTS_H_
