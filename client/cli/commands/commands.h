// SPDX-License-Identifier: Apache-2.0
// The commands. Each prints its answer and returns how it ended; an error is for the caller to print.
#ifndef FLATLIGHT_CLIENT_CLI_COMMANDS_COMMANDS_H_
#define FLATLIGHT_CLIENT_CLI_COMMANDS_COMMANDS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/connection/interruption.h"
#include "client/cli/options/command_line.h"
#include "client/cli/status/exit_code.h"

namespace flatlight {

using CommandResult = absl::StatusOr<ExitCode>;

// What most end with: prints the answer, and is done.
CommandResult Answer(const std::string& text);

CommandResult RunCommand(const CommandLine& line, Interruption& interruption);

// render_command.cc
CommandResult Render(const CommandLine& line, Interruption& interruption);

// job_commands.cc
CommandResult Submit(const CommandLine& line, Interruption& interruption);
CommandResult Watch(const CommandLine& line, Interruption& interruption);
CommandResult Jobs(const CommandLine& line, Interruption& interruption);
CommandResult Show(const CommandLine& line, Interruption& interruption);
CommandResult Fetch(const CommandLine& line, Interruption& interruption);
CommandResult Cancel(const CommandLine& line, Interruption& interruption);
CommandResult Pause(const CommandLine& line, Interruption& interruption);
CommandResult Resume(const CommandLine& line, Interruption& interruption);

// share_command.cc
CommandResult Share(const CommandLine& line, Interruption& interruption);
CommandResult Unshare(const CommandLine& line, Interruption& interruption);

// room_command.cc
CommandResult CreateRoom(const CommandLine& line, Interruption& interruption);
CommandResult Rooms(const CommandLine& line, Interruption& interruption);
CommandResult ShowRoom(const CommandLine& line, Interruption& interruption);
CommandResult WatchRoom(const CommandLine& line, Interruption& interruption);
CommandResult NoteInRoom(const CommandLine& line, Interruption& interruption);
CommandResult LookInRoom(const CommandLine& line, Interruption& interruption);
CommandResult ShareRoom(const CommandLine& line, Interruption& interruption);
CommandResult UnshareRoom(const CommandLine& line, Interruption& interruption);
CommandResult CloseRoom(const CommandLine& line, Interruption& interruption);
CommandResult DeleteRoom(const CommandLine& line, Interruption& interruption);

// top_command.cc
CommandResult Top(const CommandLine& line, Interruption& interruption);

// quota_command.cc
CommandResult ShowQuotas(const CommandLine& line, Interruption& interruption);
CommandResult ShowWebhookSecret(const CommandLine& line, Interruption& interruption);

// health_command.cc
CommandResult Health(const CommandLine& line, Interruption& interruption);

// scene_commands.cc
CommandResult Scenes(const CommandLine& line, Interruption& interruption);
CommandResult Explain(const CommandLine& line, Interruption& interruption);
CommandResult Validate(const CommandLine& line, Interruption& interruption);

// compare_command.cc
CommandResult CompareResults(const CommandLine& line, Interruption& interruption);

// figure_command.cc
CommandResult Figure(const CommandLine& line, Interruption& interruption);
std::vector<std::string> FigureNames();

// bench_command.cc
CommandResult BenchMethods(const CommandLine& line, Interruption& interruption);

// bench_compare_command.cc
CommandResult CompareBenchmarks(const CommandLine& line, Interruption& interruption);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMMANDS_COMMANDS_H_
