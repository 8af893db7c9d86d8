// SPDX-License-Identifier: Apache-2.0
#include "client/cli/outputs/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "client/cli/status/exit_code.h"

namespace flatlight {
namespace {

namespace fs = std::filesystem;

absl::Status LastError(const std::string& path) { return OutputError(path, std::strerror(errno)); }

// Where a link leads, also when nothing is there yet.
std::string Resolved(const std::string& path) {
  std::error_code error;
  const fs::path resolved = fs::weakly_canonical(path, error);
  return error ? path : resolved.string();
}

std::string FolderOf(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

// Of the file that is there already, or else what the umask lets.
mode_t FileMode(const std::string& target) {
  struct stat info {};
  if (stat(target.c_str(), &info) == 0) return info.st_mode & 0777;
  const mode_t mask = umask(0);
  umask(mask);
  return 0666 & ~mask;
}

}  // namespace

absl::Status CheckWritable(const std::string& path) {
  const std::string target = Resolved(path);
  const std::string folder = FolderOf(target);
  struct stat info {};
  if (stat(folder.c_str(), &info) != 0) return OutputError(path, "folder " + folder + ": " + std::strerror(errno));
  if (!S_ISDIR(info.st_mode)) return OutputError(path, folder + " is not a folder");
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    return OutputError(path, "folder " + folder + ": " + std::strerror(errno));
  if (stat(target.c_str(), &info) != 0) {
    if (errno == ENOENT) return absl::OkStatus();
    return LastError(path);
  }
  if (S_ISDIR(info.st_mode)) return OutputError(path, "it is a folder");
  if (!S_ISREG(info.st_mode)) return OutputError(path, "it is not a regular file");
  if (access(target.c_str(), W_OK) != 0) return LastError(path);
  return absl::OkStatus();
}

absl::StatusOr<std::unique_ptr<AtomicFile>> AtomicFile::Create(const std::string& path) {
  if (absl::Status status = CheckWritable(path); !status.ok()) return status;
  const std::string target = Resolved(path);
  std::string temporary = FolderOf(target) + "/.flatlight-XXXXXX";
  const int fd = mkostemp(temporary.data(), O_CLOEXEC);
  if (fd < 0) return LastError(path);
  fchmod(fd, FileMode(target));
  return std::unique_ptr<AtomicFile>(new AtomicFile(path, target, temporary, fd));
}

AtomicFile::AtomicFile(std::string path, std::string target, std::string temporary, int fd)
    : path_(std::move(path)), target_(std::move(target)), temporary_(std::move(temporary)), fd_(fd) {}

AtomicFile::~AtomicFile() {
  if (fd_ >= 0) close(fd_);
  if (!temporary_.empty()) unlink(temporary_.c_str());
}

absl::Status AtomicFile::Write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = write(fd_, bytes.data(), bytes.size());
    if (n < 0 && errno != EINTR) return LastError(path_);
    if (n > 0) bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return absl::OkStatus();
}

absl::Status AtomicFile::Commit() {
  if (fsync(fd_) != 0) return LastError(path_);
  const int closed = close(fd_);
  fd_ = -1;
  if (closed != 0) return LastError(path_);
  if (rename(temporary_.c_str(), target_.c_str()) != 0) return LastError(path_);
  temporary_.clear();
  return absl::OkStatus();
}

absl::Status WriteFileAtomically(const std::string& path, std::string_view bytes) {
  auto file = AtomicFile::Create(path);
  if (!file.ok()) return file.status();
  if (absl::Status status = (*file)->Write(bytes); !status.ok()) return status;
  return (*file)->Commit();
}

}  // namespace flatlight
