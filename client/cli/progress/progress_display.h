// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_PROGRESS_PROGRESS_DISPLAY_H_
#define FLATLIGHT_CLIENT_CLI_PROGRESS_PROGRESS_DISPLAY_H_

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <string>

#include "flatlight/v1/render_service.pb.h"

namespace flatlight {

// Columns of the terminal that `out` is; absent if it is none.
std::optional<std::size_t> TerminalWidth(std::FILE* out);

// Shows a job's progress: on a terminal one line, drawn over itself; elsewhere plain lines, at most one a second
// besides the first and the last.
class ProgressDisplay {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit ProgressDisplay(std::FILE* out) : out_(out) {}
  ~ProgressDisplay() { Clear(); }
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  // `width` as TerminalWidth says, asked anew each time: windows change.
  void Show(const v1::Job& job, Time now, std::optional<std::size_t> width);

  // The same for a line of other words.
  void ShowLine(const std::string& line, Time now, std::optional<std::size_t> width);

  // Takes the line off the terminal, for text to come.
  void Clear();

 private:
  void Draw(const std::string& line);
  // `last`: shown also if the one before was a moment ago.
  void ShowPlain(const std::string& line, Time now, bool last);

  std::FILE* out_;
  std::string drawn_;    // On the terminal.
  std::string printed_;  // The last plain line.
  std::optional<Time> printed_at_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_PROGRESS_PROGRESS_DISPLAY_H_
