// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_COMMANDS_CONSOLE_H_
#define FLATLIGHT_CLIENT_CLI_COMMANDS_CONSOLE_H_

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <string>

#include "absl/status/status.h"
#include "client/cli/progress/progress_display.h"
#include "client/cli/status/exit_code.h"
#include "flatlight/v1/render_service.pb.h"

namespace flatlight {

// What a command says besides its answer: plan, progress, summary. It goes to standard output, or to standard error if
// the answer is there for a machine; nowhere if it is to be quiet.
class Console {
 public:
  enum class Answer { kText, kMachine };
  Console(Answer answer, bool quiet)
      : out_(answer == Answer::kMachine ? stderr : stdout), quiet_(quiet), progress_(out_) {}

  // Whole lines, shown at once.
  void Say(const std::string& text) {
    if (quiet_) return;
    progress_.Clear();
    std::fputs(text.c_str(), out_);
    std::fflush(out_);
    NoteError();
  }

  void Show(const v1::Job& job) {
    if (quiet_) return;
    progress_.Show(job, std::chrono::steady_clock::now(), TerminalWidth(out_));
    NoteError();
  }

  // A line on how far the work is, in other words.
  void ShowLine(const std::string& line) {
    if (quiet_) return;
    progress_.ShowLine(line, std::chrono::steady_clock::now(), TerminalWidth(out_));
    NoteError();
  }

  void EndProgress() { progress_.Clear(); }

  // Why something that was said could not be written to standard output: the first reason.
  absl::Status status() const {
    return error_ == 0 ? absl::OkStatus() : OutputError("standard output", std::strerror(error_));
  }

  // Updates a second that are worth having.
  double Rate() const { return TerminalWidth(out_) ? 10 : 2; }

 private:
  // Right after a write, while errno is its own.
  void NoteError() {
    if (error_ == 0 && out_ == stdout && std::ferror(out_) != 0) error_ = errno;
  }

  std::FILE* out_;
  bool quiet_;
  int error_ = 0;
  ProgressDisplay progress_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMMANDS_CONSOLE_H_
