// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/commands.h"

#include <map>
#include <string>

#include "client/cli/outputs/outputs.h"

namespace flatlight {

CommandResult Answer(const std::string& text) {
  if (absl::Status printed = PrintBytes(text); !printed.ok()) return printed;
  return ExitCode::kDone;
}

CommandResult RunCommand(const CommandLine& line, Interruption& interruption) {
  static const std::map<std::string, CommandResult (*)(const CommandLine&, Interruption&)> kCommands = {
      {"render", Render},
      {"submit", Submit},
      {"watch", Watch},
      {"jobs", Jobs},
      {"top", Top},
      {"health", Health},
      {"quota", ShowQuotas},
      {"webhook-secret", ShowWebhookSecret},
      {"show", Show},
      {"fetch", Fetch},
      {"cancel", Cancel},
      {"pause", Pause},
      {"resume", Resume},
      {"share", Share},
      {"unshare", Unshare},
      {"room create", CreateRoom},
      {"room list", Rooms},
      {"room show", ShowRoom},
      {"room watch", WatchRoom},
      {"room note", NoteInRoom},
      {"room look", LookInRoom},
      {"room share", ShareRoom},
      {"room unshare", UnshareRoom},
      {"room close", CloseRoom},
      {"room delete", DeleteRoom},
      {"scenes", Scenes},
      {"explain", Explain},
      {"validate", Validate},
      {"compare", CompareResults},
      {"figure", Figure},
      {"bench", BenchMethods},
      {"bench compare", CompareBenchmarks}};
  return kCommands.at(line.command)(line, interruption);
}

}  // namespace flatlight
