// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/commands.h"
#include "client/cli/commands/server_choice.h"
#include "client/cli/connection/health.h"

namespace flatlight {

CommandResult Health(const CommandLine& line, Interruption& interruption) {
  const auto server = ChosenServer(line);
  if (!server.ok()) return server.status();
  if (!server->has_value())
    return UsageError("`flatlight health` needs a server: give --server HOST:PORT or set FLATLIGHT_SERVER");
  if (absl::Status healthy = CheckHealth((*server)->address, (*server)->tls, interruption); !healthy.ok())
    return healthy;
  if (line.quiet) return ExitCode::kDone;
  return Answer((*server)->address.text + " SERVING\n");
}

}  // namespace flatlight
