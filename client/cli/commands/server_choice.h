// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_COMMANDS_SERVER_CHOICE_H_
#define FLATLIGHT_CLIENT_CLI_COMMANDS_SERVER_CHOICE_H_

#include <optional>

#include "absl/status/statusor.h"
#include "client/cli/connection/server_address.h"
#include "client/cli/options/command_line.h"
#include "client/cli/tls/tls.h"

namespace flatlight {

struct ServerChoice {
  ServerAddress address;
  Tls tls;
};

// The server of --server, or else of FLATLIGHT_SERVER, and how to speak with it; nothing without either. Errors, of
// addresses and TLS files that are none, end with ExitCode::kUsage.
absl::StatusOr<std::optional<ServerChoice>> ChosenServer(const CommandLine& line);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMMANDS_SERVER_CHOICE_H_
