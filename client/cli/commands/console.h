// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_COMMANDS_CONSOLE_H_
#define FLATLIGHT_CLIENT_CLI_COMMANDS_CONSOLE_H_

#include <chrono>
#include <cstdio>
#include <string>

#include "client/cli/progress/progress_display.h"
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
  }

  void Show(const v1::Job& job) {
    if (!quiet_) progress_.Show(job, std::chrono::steady_clock::now(), TerminalWidth(out_));
  }

  void EndProgress() { progress_.Clear(); }

  // Updates a second that are worth having.
  double Rate() const { return TerminalWidth(out_) ? 10 : 2; }

 private:
  std::FILE* out_;
  bool quiet_;
  ProgressDisplay progress_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMMANDS_CONSOLE_H_
