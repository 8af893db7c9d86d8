// SPDX-License-Identifier: Apache-2.0
#include "server/telemetry/json_log.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <utility>

#include "server/store/error.h"

namespace flatlight {
namespace {

absl::StatusOr<int> OpenToAppend(const std::string& path) {
  if (path == "-") return dup(STDERR_FILENO);
  const int fd = open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (fd >= 0) return fd;
  return MakeError(absl::StatusCode::kUnavailable, "CANNOT_LOG",
                   "cannot write the log " + path + ": " + std::strerror(errno));
}

// RFC 3339 in UTC, with milliseconds.
std::string Now() {
  timespec time{};
  clock_gettime(CLOCK_REALTIME, &time);
  std::tm parts{};
  gmtime_r(&time.tv_sec, &parts);
  std::array<char, 64> text;
  const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S", &parts);
  std::snprintf(text.data() + length, text.size() - length, ".%03dZ", static_cast<int>(time.tv_nsec / 1'000'000));
  return text.data();
}

}  // namespace

absl::StatusOr<std::unique_ptr<JsonLog>> JsonLog::Open(const std::string& path) {
  const auto fd = OpenToAppend(path);
  if (!fd.ok()) return fd.status();
  return std::unique_ptr<JsonLog>(new JsonLog(path, *fd));
}

JsonLog::~JsonLog() { close(fd_); }

void JsonLog::Write(const Line& line) {
  Line whole;
  whole["time"] = Now();
  whole.update(line);
  const std::string text = whole.dump(-1, ' ', false, Line::error_handler_t::replace) + "\n";
  const std::lock_guard lock(mutex_);
  ssize_t written = 0;
  do {
    written = write(fd_, text.data(), text.size());
  } while (written < 0 && errno == EINTR);
  if (written == static_cast<ssize_t>(text.size())) return;
  ++lost_lines_;
  // The next line is not to be joined to a broken one.
  if (written > 0 && write(fd_, "\n", 1) != 1) ++lost_lines_;
}

absl::Status JsonLog::Reopen() {
  const auto fd = OpenToAppend(path_);
  if (!fd.ok()) return fd.status();
  const std::lock_guard lock(mutex_);
  close(std::exchange(fd_, *fd));
  return absl::OkStatus();
}

}  // namespace flatlight
