// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_COMMANDS_RECORD_ERROR_FIGURE_H_
#define FLATLIGHT_CLIENT_CLI_COMMANDS_RECORD_ERROR_FIGURE_H_

#include "client/cli/commands/commands.h"

namespace flatlight {

// The error of irradiance caching against the number of records, for every error control and degree: a table of slopes
// and errors, CSV, a plot of a panel a degree.
CommandResult DrawRecordErrors(const CommandLine& line, Interruption& interruption);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMMANDS_RECORD_ERROR_FIGURE_H_
