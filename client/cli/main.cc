// SPDX-License-Identifier: Apache-2.0
// flatlight: the command line. Talks to a server and does nothing else with light.
#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>

#include "client/cli/commands/commands.h"
#include "client/cli/outputs/outputs.h"

namespace flatlight {
namespace {

ExitCode Fail(const absl::Status& status) {
  std::istringstream lines(std::string(status.message().data(), status.message().size()));
  for (std::string line; std::getline(lines, line);) std::fprintf(stderr, "flatlight: %s\n", line.c_str());
  return ExitCodeOf(status);
}

// Gives standard streams that are closed a place that is empty and cannot be written to: or else the next file or
// socket to be opened would take their number. Before everything else, as gRPC opens one when it is loaded.
void FillClosedStreams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0) open("/dev/null", O_RDONLY);
}
__attribute__((section(".preinit_array"), used)) void (*fill_closed_streams)() = FillClosedStreams;

ExitCode Main(int argc, char** argv) {
  const auto line = ParseCommandLine(argc, argv, FLATLIGHT_VERSION);
  if (!line.ok()) return Fail(line.status());
  if (line->command.empty()) {
    const absl::Status printed = PrintBytes(line->text);
    return printed.ok() ? ExitCode::kDone : Fail(printed);
  }
  Interruption interruption;
  const CommandResult result = RunCommand(*line, interruption);
  return result.ok() ? *result : Fail(result.status());
}

}  // namespace
}  // namespace flatlight

int main(int argc, char** argv) {
  // Broken pipes and file size limits are errors of the write that meets them.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  setenv("GRPC_VERBOSITY", "NONE", 0);  // Its log lines would come between ours; its errors reach us as results.
  return static_cast<int>(flatlight::Main(argc, argv));
}
