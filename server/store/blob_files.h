// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_BLOB_FILES_H_
#define FLATLIGHT_SERVER_STORE_BLOB_FILES_H_

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace flatlight {

// Files that are named by the SHA-256 of their bytes and never change: FOLDER/ab/abcd….
class BlobFiles {
 public:
  explicit BlobFiles(std::string folder) : folder_(std::move(folder)) {}

  enum class IfThere : std::uint8_t { kLeave, kReplace };
  // On return the bytes are on the disk under their name, or, on an error, nothing is. One that is there already is
  // left as it is, or, so that this takes as long as if it were not, replaced by itself.
  absl::Status Write(const std::string& sha256, std::string_view bytes, IfThere if_there = IfThere::kLeave);
  // DATA_LOSS if it is missing or its bytes are not those of its name.
  absl::StatusOr<std::string> Read(const std::string& sha256) const;
  void Remove(const std::string& sha256);
  // Removes whatever `wanted` does not want, and what writes that were broken off left.
  void Sweep(const std::function<bool(const std::string& sha256)>& wanted);
  std::string PathOf(const std::string& sha256) const { return folder_ + "/" + sha256.substr(0, 2) + "/" + sha256; }

 private:
  const std::string folder_;
};

// Files and folders, with errors as StorageError makes them.
absl::Status MakeFolder(const std::string& path);  // If it is missing; for its owner alone.
absl::Status SyncFolder(const std::string& path);  // So that its entries outlive the machine's power.
absl::StatusOr<std::string> ReadFile(const std::string& path);
// Under a temporary name beside it, then renamed, both synced.
absl::Status WriteFile(const std::string& path, std::string_view bytes);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_BLOB_FILES_H_
