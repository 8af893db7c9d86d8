// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_STORAGE_H_
#define FLATLIGHT_SERVER_STORE_STORAGE_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/store/blob_files.h"
#include "server/store/database.h"

namespace flatlight {

// Bytes that are to be kept, with their hash.
struct Blob {
  std::string sha256;
  std::shared_ptr<const std::string> bytes;
};

// The folder of a server: a database, and files of large blobs. One server at a time. Safe to use from any thread.
class Storage {
 public:
  // Blobs of at most so many bytes lie in the database.
  static constexpr std::size_t kMostInlineBytes = 64u << 10;

  // Makes the folder if it is missing, brings an older database up to date, and removes what was broken off.
  // UNAVAILABLE if another server uses it.
  static absl::StatusOr<std::unique_ptr<Storage>> Open(const std::string& folder);
  ~Storage();

  // A transaction: on an error nothing has happened.
  class Writing {
   public:
    Database& database() { return storage_.database(); }
    Statement Prepare(const std::string& sql) { return database().Prepare(sql); }
    // One more, or one less, column names the blob.
    absl::Status Use(const Blob& blob);
    // What is there already is written once more: so that this takes as long as Use of what is new.
    absl::Status Rewrite(const Blob& blob);
    absl::Status Release(const std::optional<std::string>& sha256);

   private:
    friend class Storage;
    explicit Writing(Storage& storage) : storage_(storage) {}
    Storage& storage_;
    std::vector<std::string> touched_;
  };
  absl::Status Write(const std::function<absl::Status(Writing&)>& work);
  absl::Status Read(const std::function<absl::Status(Database&)>& work);

  // Hashes bytes and writes a large blob's file, before the transaction that uses it.
  absl::StatusOr<Blob> Prepare(std::string bytes);
  absl::StatusOr<Blob> Prepare(std::string sha256, std::shared_ptr<const std::string> bytes,
                               BlobFiles::IfThere if_there = BlobFiles::IfThere::kLeave);
  // Checked against its hash.
  absl::StatusOr<std::string> Fetch(const std::string& sha256);

  // How many bytes it has; 0 if it is missing.
  std::uint64_t SizeOf(const std::string& sha256);

  const std::string& folder() const { return folder_; }
  static std::string DatabasePath(const std::string& folder) { return folder + "/flatlight.db"; }
  static std::string BlobFolder(const std::string& folder) { return folder + "/blobs"; }

 private:
  Storage(const std::string& folder, int lock_fd) : folder_(folder), lock_fd_(lock_fd), files_(BlobFolder(folder)) {}
  Database& database() { return *database_; }
  // Removes files that nothing names any more.
  void RemoveUnused(const std::vector<std::string>& touched) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const std::string folder_;
  const int lock_fd_;
  BlobFiles files_;
  std::mutex mutex_;
  std::unique_ptr<Database> database_;  // Used with the mutex held.
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_STORAGE_H_
