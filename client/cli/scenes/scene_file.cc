// SPDX-License-Identifier: Apache-2.0
#include "client/cli/scenes/scene_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "client/cli/status/exit_code.h"
#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

constexpr const char* kGallery = "gallery:";
constexpr std::size_t kChunk = 1U << 20;

bool IsUploadName(const std::string& text) {
  const std::string prefix = "scenes/";
  return text.size() == prefix.size() + kHashDigits && text.starts_with(prefix) &&
         text.find_first_not_of("0123456789abcdef", prefix.size()) == std::string::npos;
}

absl::Status TooLong(const std::string& label, const std::string& size, std::uint64_t limit) {
  return UsageError(label + " has " + size + "; allowed are at most " + FormatBytes(static_cast<double>(limit)));
}

absl::Status LastError(const std::string& label) {
  return UsageError(label + " cannot be read: " + std::strerror(errno));
}

absl::StatusOr<std::string> ReadAll(int fd, const std::string& label, std::uint64_t limit,
                                    const Interruption& interruption) {
  struct stat info {};
  if (fstat(fd, &info) != 0) return LastError(label);
  if (S_ISDIR(info.st_mode)) return UsageError(label + " is a folder, not a file");
  std::string bytes;
  if (S_ISREG(info.st_mode)) {
    const auto size = static_cast<std::uint64_t>(info.st_size);
    if (size > limit) return TooLong(label, FormatBytes(static_cast<double>(size)), limit);
    bytes.reserve(size + kChunk);
  }
  for (;;) {
    if (!interruption.AwaitReadable(fd)) return InterruptedError("interrupted");
    const std::size_t old_size = bytes.size();
    bytes.resize(old_size + kChunk);
    const ssize_t n = read(fd, bytes.data() + old_size, kChunk);
    if (n < 0 && errno != EINTR && errno != EAGAIN) return LastError(label);
    bytes.resize(old_size + static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    if (bytes.size() > limit) return TooLong(label, "more than " + FormatBytes(static_cast<double>(limit)), limit);
    if (n == 0) break;
  }
  if (bytes.empty()) return UsageError(label + " is empty");
  return bytes;
}

}  // namespace

absl::StatusOr<SceneArgument> ParseSceneArgument(const std::string& text) {
  if (text.empty()) return UsageError("SCENE is empty; must be a file, - or gallery:NAME");
  if (text == "-") return SceneArgument{"standard input", "", "-"};
  if (IsUploadName(text)) return SceneArgument{text, text, ""};
  if (!text.starts_with(kGallery)) return SceneArgument{Printable(text), "", text};
  const std::string name = text.substr(std::strlen(kGallery));
  if (name.empty() || name.find('/') != std::string::npos)
    return UsageError("'" + text + "' names no gallery scene; `flatlight scenes` lists them");
  return SceneArgument{text, "scenes/" + name, ""};
}

absl::Status CheckSceneFile(const SceneArgument& scene) {
  if (scene.from_server() || scene.path == "-") return absl::OkStatus();
  struct stat info {};
  if (stat(scene.path.c_str(), &info) != 0 || access(scene.path.c_str(), R_OK) != 0) return LastError(scene.label);
  if (S_ISDIR(info.st_mode)) return UsageError(scene.label + " is a folder, not a file");
  return absl::OkStatus();
}

absl::StatusOr<std::string> ReadFile(const std::string& path, const std::string& label, std::uint64_t limit,
                                     const Interruption& interruption) {
  if (path == "-") return ReadAll(STDIN_FILENO, label, limit, interruption);
  // Not to wait in open for a FIFO's writer: the first read awaits it.
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) return LastError(label);
  absl::StatusOr<std::string> bytes = ReadAll(fd, label, limit, interruption);
  close(fd);
  return bytes;
}

}  // namespace flatlight
