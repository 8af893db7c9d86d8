// SPDX-License-Identifier: Apache-2.0
// Files that are there whole or not at all.
#ifndef FLATLIGHT_CLIENT_CLI_OUTPUTS_ATOMIC_FILE_H_
#define FLATLIGHT_CLIENT_CLI_OUTPUTS_ATOMIC_FILE_H_

#include <memory>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace flatlight {

// OK if a file could be written at `path` now: its folder exists and can be written to, and what is there, if anything,
// is a regular file. Errors name the path and end with ExitCode::kOutput.
absl::Status CheckWritable(const std::string& path);

// A file under a temporary name in the folder of `path`, with the permissions of the file that it replaces, or else
// those that the umask lets. It takes its place on Commit; it is gone if there is none. A symbolic link is followed,
// not replaced.
class AtomicFile {
 public:
  static absl::StatusOr<std::unique_ptr<AtomicFile>> Create(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  absl::Status Write(std::string_view bytes);
  // Onto the disk, then under its name.
  absl::Status Commit();

 private:
  AtomicFile(std::string path, std::string target, std::string temporary, int fd);

  std::string path_;    // As given, for messages.
  std::string target_;  // Links resolved.
  std::string temporary_;
  int fd_;
};

absl::Status WriteFileAtomically(const std::string& path, std::string_view bytes);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_OUTPUTS_ATOMIC_FILE_H_
