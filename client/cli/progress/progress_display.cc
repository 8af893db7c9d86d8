// SPDX-License-Identifier: Apache-2.0
#include "client/cli/progress/progress_display.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include "client/cli/progress/progress_line.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

constexpr std::chrono::seconds kPlainInterval{1};
constexpr const char* kEraseLine = "\r\x1b[K";  // To the first column; erase to the end (ECMA-48, EL).

bool Ended(const v1::Job& job) {
  return job.state() == v1::Job::SUCCEEDED || job.state() == v1::Job::FAILED || job.state() == v1::Job::CANCELLED;
}

}  // namespace

std::optional<std::size_t> TerminalWidth(std::FILE* out) {
  const int fd = fileno(out);
  if (fd < 0 || isatty(fd) == 0) return std::nullopt;
  winsize size{};
  if (ioctl(fd, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
  return size.ws_col;
}

void ProgressDisplay::Show(const v1::Job& job, Time now, std::optional<std::size_t> width) {
  if (!width) return ShowPlain(ProgressLine(job, 0), now, Ended(job));
  // The last column stays free: some terminals wrap as soon as it is written.
  Draw(ProgressLine(job, *width > 1 ? *width - 1 : 1));
}

void ProgressDisplay::ShowLine(const std::string& line, Time now, std::optional<std::size_t> width) {
  if (!width) return ShowPlain(line, now, false);
  Draw(CutToWidth(line, *width > 1 ? *width - 1 : 1));
}

void ProgressDisplay::Draw(const std::string& line) {
  if (line == drawn_) return;
  std::fprintf(out_, "%s%s", kEraseLine, line.c_str());
  std::fflush(out_);
  drawn_ = line;
}

void ProgressDisplay::Clear() {
  if (drawn_.empty()) return;
  std::fputs(kEraseLine, out_);
  std::fflush(out_);
  drawn_.clear();
}

void ProgressDisplay::ShowPlain(const std::string& line, Time now, bool last) {
  if (!last && printed_at_ && now - *printed_at_ < kPlainInterval) return;
  if (line == printed_) return;
  std::fprintf(out_, "%s\n", line.c_str());
  std::fflush(out_);
  printed_ = line;
  printed_at_ = now;
}

}  // namespace flatlight
