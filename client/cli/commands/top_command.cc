// SPDX-License-Identifier: Apache-2.0
#include <sys/ioctl.h>
#include <unistd.h>

#include <chrono>
#include <string>

#include "client/cli/commands/activity_text.h"
#include "client/cli/commands/commands.h"
#include "client/cli/commands/session.h"
#include "client/cli/formats/json_text.h"
#include "client/cli/outputs/outputs.h"

namespace flatlight {
namespace {

constexpr std::chrono::milliseconds kRefresh{1000};
constexpr std::chrono::milliseconds kFirstLook{300};  // Rates need two looks.
constexpr std::size_t kPlainWidth = 80;

// The alternate screen for as long as it lives: what was on the terminal is there again afterwards.
class Screen {
 public:
  absl::Status Draw(const std::string& text) {
    std::string bytes = entered_ ? "" : "\x1b[?1049h\x1b[?25l";
    entered_ = true;
    bytes += "\x1b[H";
    for (const char c : text) bytes += c == '\n' ? std::string("\x1b[K\r\n") : std::string(1, c);
    return PrintBytes(bytes + "\x1b[J");
  }
  ~Screen() {
    if (entered_) PrintBytes("\x1b[?25h\x1b[?1049l").IgnoreError();
  }

 private:
  bool entered_ = false;
};

}  // namespace

CommandResult Top(const CommandLine& line, Interruption& interruption) {
  const auto session = Session::Open(line, Session::WithoutServer::kRefuse, interruption);
  if (!session.ok()) return session.status();
  Connection& connection = (*session)->connection();
  const bool live = !line.once && !line.json && isatty(STDOUT_FILENO) != 0;
  v1::GetActivityResponse before;
  Screen screen;
  for (bool first = true;; first = false) {
    v1::GetActivityResponse now;
    const absl::Status asked =
        connection.Call(connection.server(), &v1::ServerService::Stub::GetActivity, v1::GetActivityRequest(), now);
    if (interruption.Requested()) return ExitCode::kDone;
    if (!asked.ok()) return asked;
    if (line.json) {
      if (absl::Status printed = PrintBytes(ToJson(now)); !printed.ok()) return printed;
      return ExitCode::kDone;
    }
    if (!first) {
      winsize size{};
      const bool known = live && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 && size.ws_row > 1;
      const std::string text = ActivityText(connection.address(), connection.capabilities(), before, now,
                                            known ? size.ws_col - 1U : kPlainWidth, known ? size.ws_row - 1U : 0);
      const absl::Status shown = live ? screen.Draw(text) : PrintBytes(text);
      if (!shown.ok()) return shown;
      if (!live) return ExitCode::kDone;
    }
    before = now;
    if (!interruption.Sleep(first ? kFirstLook : kRefresh)) return ExitCode::kDone;
  }
}

}  // namespace flatlight
