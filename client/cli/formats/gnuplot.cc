// SPDX-License-Identifier: Apache-2.0
#include "client/cli/formats/gnuplot.h"

#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>

namespace flatlight {
namespace {

// A file in memory: gnuplot's input, output and errors need neither pipes that could block each other nor a folder.
class MemoryFile {
 public:
  MemoryFile() : fd_(memfd_create("flatlight-plot", MFD_CLOEXEC)) {}
  ~MemoryFile() {
    if (fd_ >= 0) close(fd_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  int fd() const { return fd_; }

  bool Fill(const std::string& text) {
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t n = write(fd_, text.data() + done, text.size() - done);
      if (n < 0) return false;
      done += static_cast<std::size_t>(n);
    }
    return lseek(fd_, 0, SEEK_SET) == 0;
  }

  std::string Contents() const {
    std::string text;
    std::array<char, 65536> buffer{};
    for (;;) {
      const ssize_t n = pread(fd_, buffer.data(), buffer.size(), static_cast<off_t>(text.size()));
      if (n <= 0) return text;
      text.append(buffer.data(), static_cast<std::size_t>(n));
    }
  }

 private:
  int fd_;
};

// The first line of gnuplot's complaint that says something.
std::string Complaint(const std::string& errors) {
  std::istringstream lines(errors);
  std::string line, last = "no reason given";
  while (std::getline(lines, line))
    if (line.find_first_not_of(" \t^\r") != std::string::npos) last = line;
  return last;
}

// -1 if it could not be started, with errno.
int Run(const MemoryFile& input, const MemoryFile& output, const MemoryFile& errors) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, input.fd(), 0);
  posix_spawn_file_actions_adddup2(&files, output.fd(), 1);
  posix_spawn_file_actions_adddup2(&files, errors.fd(), 2);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);  // Ours blocks SIGINT, see interruption.h.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  std::string name = "gnuplot";
  std::array<char*, 2> arguments = {name.data(), nullptr};
  pid_t child = 0;
  const int error = posix_spawnp(&child, name.c_str(), &files, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  if (error != 0) {
    errno = error;
    return -1;
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return status;
}

}  // namespace

absl::Status FindGnuplot() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "/usr/bin:/bin" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((folder + "/gnuplot").c_str(), X_OK) == 0) return absl::OkStatus();
  return absl::FailedPreconditionError("plots need the program gnuplot, which is not in PATH (Debian: gnuplot-nox)");
}

absl::StatusOr<std::string> RunGnuplot(const std::string& script) {
  MemoryFile input, output, errors;
  if (input.fd() < 0 || output.fd() < 0 || errors.fd() < 0 || !input.Fill(script))
    return absl::InternalError(std::string("no room for the plot in memory: ") + std::strerror(errno));
  const int status = Run(input, output, errors);
  if (status < 0) return absl::InternalError(std::string("gnuplot could not be run: ") + std::strerror(errno));
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    return absl::InternalError("gnuplot failed: " + Complaint(errors.Contents()));
  std::string picture = output.Contents();
  if (picture.empty()) return absl::InternalError("gnuplot drew nothing: " + Complaint(errors.Contents()));
  return picture;
}

}  // namespace flatlight
