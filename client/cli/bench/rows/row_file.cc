// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/rows/row_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "client/cli/bench/rows/row_columns.h"
#include "client/cli/bench/rows/row_reader.h"
#include "client/cli/status/exit_code.h"
#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

constexpr off_t kMostBytes = 1 << 30;

absl::StatusOr<std::string> ReadAll(int fd, const std::string& path) {
  struct stat info {};
  if (fstat(fd, &info) != 0) return OutputError(path, std::strerror(errno));
  if (!S_ISREG(info.st_mode)) return OutputError(path, "it is not a regular file");
  if (info.st_size > kMostBytes) return UsageError(path + " has more than " + FormatBytes(kMostBytes));
  std::string bytes(static_cast<std::size_t>(info.st_size), '\0');
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = pread(fd, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return UsageError(path + " cannot be read: " + std::strerror(errno));
    if (n == 0) bytes.resize(done);
    done += static_cast<std::size_t>(n);
  }
  return bytes;
}

}  // namespace

absl::StatusOr<std::unique_ptr<RowFile>> RowFile::Open(const std::string& path) {
  std::unique_ptr<RowFile> file(new RowFile(path));
  if (absl::Status opened = file->OpenDescriptor(0); !opened.ok()) return opened;
  if (file->fd_ < 0) return file;
  const auto bytes = ReadAll(file->fd_, path);
  if (!bytes.ok()) return bytes.status();
  auto rows = RowsFromCsv(*bytes, Printable(path));
  if (!rows.ok()) return rows.status();
  file->rows_ = *std::move(rows);
  file->empty_ = bytes->empty();
  // Columns in another order can be read, but not be written.
  if (!file->empty_ && !bytes->starts_with(RowHeader()))
    return UsageError(Printable(path) + ": line 1, column 1: the columns are in another order than `flatlight bench`" +
                      " writes them, so nothing can be appended; name another file");
  return file;
}

absl::Status RowFile::OpenDescriptor(int flags) {
  fd_ = open(path_.c_str(), O_RDWR | O_APPEND | O_CLOEXEC | O_NONBLOCK | flags, 0666);
  if (fd_ < 0) return flags == 0 && errno == ENOENT ? absl::OkStatus() : OutputError(path_, std::strerror(errno));
  if (flock(fd_, LOCK_EX | LOCK_NB) != 0)
    return OutputError(path_, errno == EWOULDBLOCK ? "another benchmark is writing to it" : std::strerror(errno));
  return absl::OkStatus();
}

RowFile::~RowFile() {
  if (fd_ >= 0) close(fd_);
}

absl::Status RowFile::Append(const BenchRow& row) {
  if (fd_ < 0)
    if (absl::Status opened = OpenDescriptor(O_CREAT | O_EXCL); !opened.ok()) return opened;
  if (absl::Status written = Write((empty_ ? RowHeader() : "") + RowText(row)); !written.ok()) return written;
  empty_ = false;
  rows_.push_back(row);
  return absl::OkStatus();
}

absl::Status RowFile::Write(const std::string& text) {
  const off_t size = lseek(fd_, 0, SEEK_END);
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n = write(fd_, text.data() + done, text.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      const int error = errno;
      const bool undone = ftruncate(fd_, size) == 0;
      return OutputError(path_, std::strerror(error) + std::string(undone ? "" : "; its last row is cut short"));
    }
    done += static_cast<std::size_t>(n);
  }
  return absl::OkStatus();
}

}  // namespace flatlight
