// SPDX-License-Identifier: Apache-2.0
// The figures of irradiance caching.
#ifndef FLATLIGHT_CLIENT_CLI_COMMANDS_CACHING_FIGURES_H_
#define FLATLIGHT_CLIENT_CLI_COMMANDS_CACHING_FIGURES_H_

#include <optional>
#include <string>
#include <vector>

#include "client/cli/commands/commands.h"

namespace flatlight {

std::vector<std::string> CachingFigureNames();

// Absent if line.figure is none of them.
std::optional<CommandResult> DrawCachingFigure(const CommandLine& line, Interruption& interruption);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMMANDS_CACHING_FIGURES_H_
