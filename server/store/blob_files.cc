// SPDX-License-Identifier: Apache-2.0
#include "server/store/blob_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <vector>

#include "server/store/database.h"
#include "server/store/error.h"
#include "server/store/sha256.h"

namespace flatlight {
namespace {

constexpr char kTemporary[] = ".part";

class File {
 public:
  File(const std::string& path, int flags) : fd_(open(path.c_str(), flags | O_CLOEXEC, 0600)) {}
  ~File() {
    if (fd_ >= 0) close(fd_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  bool ok() const { return fd_ >= 0; }
  int fd() const { return fd_; }

 private:
  int fd_;
};

bool WriteAll(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = write(fd, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

}  // namespace

absl::Status MakeFolder(const std::string& path) {
  if (mkdir(path.c_str(), 0700) == 0 || errno == EEXIST) return absl::OkStatus();
  return StorageError(path, errno);
}

absl::Status SyncFolder(const std::string& path) {
  const File folder(path, O_RDONLY | O_DIRECTORY);
  if (!folder.ok() || fsync(folder.fd()) != 0) return StorageError(path, errno);
  return absl::OkStatus();
}

absl::StatusOr<std::string> ReadFile(const std::string& path) {
  const File file(path, O_RDONLY);
  struct stat about {};
  if (!file.ok() || fstat(file.fd(), &about) != 0) return StorageError(path, errno);
  std::string bytes(static_cast<std::size_t>(about.st_size), '\0');
  std::size_t read_bytes = 0;
  while (read_bytes < bytes.size()) {
    const ssize_t count = read(file.fd(), bytes.data() + read_bytes, bytes.size() - read_bytes);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return StorageError(path, errno);
    if (count == 0) break;
    read_bytes += static_cast<std::size_t>(count);
  }
  bytes.resize(read_bytes);
  return bytes;
}

absl::Status WriteFile(const std::string& path, std::string_view bytes) {
  static std::atomic<unsigned> next = 0;
  const std::string temporary = path + "." + std::to_string(getpid()) + "-" + std::to_string(next++) + kTemporary;
  int failed = 0;
  {
    const File file(temporary, O_WRONLY | O_CREAT | O_EXCL);
    if (!file.ok()) return StorageError(path, errno);
    if (!WriteAll(file.fd(), bytes) || fsync(file.fd()) != 0) failed = errno;
  }
  if (failed == 0 && rename(temporary.c_str(), path.c_str()) != 0) failed = errno;
  if (failed != 0) {
    unlink(temporary.c_str());
    return StorageError(path, failed);
  }
  return SyncFolder(path.substr(0, path.rfind('/')));
}

absl::Status BlobFiles::Write(const std::string& sha256, std::string_view bytes, IfThere if_there) {
  const std::string path = PathOf(sha256);
  if (if_there == IfThere::kLeave && access(path.c_str(), F_OK) == 0) return absl::OkStatus();
  const std::string folder = path.substr(0, path.rfind('/'));
  if (access(folder.c_str(), F_OK) != 0) {
    for (const std::string& needed : {folder_, folder}) {
      if (absl::Status made = MakeFolder(needed); !made.ok()) return made;
    }
    if (absl::Status synced = SyncFolder(folder_); !synced.ok()) return synced;
  }
  return WriteFile(path, bytes);
}

absl::StatusOr<std::string> BlobFiles::Read(const std::string& sha256) const {
  auto bytes = ReadFile(PathOf(sha256));
  if (bytes.ok() && Sha256Of(*bytes) == sha256) return bytes;
  const std::string why = bytes.ok() ? "its bytes are not what was written" : std::string(bytes.status().message());
  return MakeError(absl::StatusCode::kDataLoss, "STORAGE_DAMAGED",
                   PathOf(sha256) + " is damaged: " + why + "; restore it from a backup");
}

void BlobFiles::Remove(const std::string& sha256) { unlink(PathOf(sha256).c_str()); }

void BlobFiles::Sweep(const std::function<bool(const std::string& sha256)>& wanted) {
  std::vector<std::filesystem::path> unwanted;
  std::error_code error;  // What cannot be read is left alone.
  for (std::filesystem::recursive_directory_iterator entry(folder_, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->is_directory(error)) continue;
    if (!wanted(entry->path().filename().string())) unwanted.push_back(entry->path());
  }
  for (const auto& path : unwanted) std::filesystem::remove(path, error);
}

}  // namespace flatlight
