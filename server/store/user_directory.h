// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_USER_DIRECTORY_H_
#define FLATLIGHT_SERVER_STORE_USER_DIRECTORY_H_

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "server/store/database.h"
#include "server/store/user_store.h"

namespace flatlight {

// The users as every call asks for them. What was found is remembered until any user is changed, which is seen at once,
// whichever process did it. Safe to use from any thread.
class UserDirectory {
 public:
  // A connection for this alone, which never writes.
  explicit UserDirectory(std::unique_ptr<Database> database);

  // As UserStore::HasUsers; once true, it stays so.
  absl::StatusOr<bool> HasUsers();
  // As UserStore::FindByTokenHash.
  absl::StatusOr<User> FindByTokenHash(const std::string& token_sha256);
  // As UserStore::FindRole; not remembered.
  absl::StatusOr<std::optional<Role>> FindRole(const std::string& name);
  // Another number whenever any user may have been changed, and when that cannot be told.
  std::int64_t Version();

 private:
  // More than a class and its staff: then all of it is forgotten.
  static constexpr std::size_t kMostRemembered = 4096;

  absl::Status ForgetWhatChanged() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::StatusOr<std::int64_t> ReadVersion() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  std::mutex mutex_;
  const std::unique_ptr<Database> database_ ABSL_PT_GUARDED_BY(mutex_);
  Statement version_query_ ABSL_GUARDED_BY(mutex_);
  std::optional<Database::LogHeader> seen_ ABSL_GUARDED_BY(mutex_);  // Before the version was read.
  std::int64_t version_ ABSL_GUARDED_BY(mutex_) = -1;
  std::int64_t unreadable_ ABSL_GUARDED_BY(mutex_) = -1;
  std::optional<bool> has_users_ ABSL_GUARDED_BY(mutex_);
  std::atomic<bool> ever_had_users_ =
      false;  // As has_users_, once it is true: asked with every call, without the lock.
  std::unordered_map<std::string, User> by_token_hash_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_USER_DIRECTORY_H_
