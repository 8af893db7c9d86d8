// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_WEBHOOK_OUTBOX_H_
#define FLATLIGHT_SERVER_STORE_WEBHOOK_OUTBOX_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/store/database.h"
#include "server/store/job.h"
#include "server/store/webhook_secret_table.h"

namespace flatlight {

// How far a job's webhook is.
struct WebhookState {
  std::string url;
  unsigned attempts = 0;
  std::string error;                     // Of the last attempt; empty: none, or it was taken.
  std::optional<WallTime> next_attempt;  // The job has ended, and it is to be tried (again), then or at once.
  std::optional<WallTime> end_time;      // Nothing more is done: it was delivered, or given up.
  bool delivered = false;
};

// One that is to be sent.
struct DueWebhook {
  std::int64_t number = 0;
  JobId job;
  std::string owner;
  std::string url;
  std::string body;
  unsigned attempts = 0;  // Made so far.
};

// Webhooks that wait for the end of their job, or to be sent, or have been. Each change is committed when the call
// returns. Safe to use from any thread.
class WebhookOutbox {
 public:
  // `database`: a connection of its own, of the newest schema.
  explicit WebhookOutbox(std::unique_ptr<Database> database) : database_(std::move(database)) {}

  // As in webhook_table.h, for jobs that are in no database.
  absl::Status Insert(const JobId& job, const std::string& owner, const std::string& url);
  absl::Status MakeDue(const JobId& job, const std::string& body);
  absl::Status Detach(const JobId& job);

  // Nothing of a job that has no webhook.
  absl::StatusOr<std::optional<WebhookState>> Of(const JobId& job);
  // How many of an owner, or of all, have not been delivered or given up.
  absl::StatusOr<std::size_t> OpenOf(const std::optional<std::string>& owner);

  // Those that are to be sent now, at most `per_owner` of each owner: those that were never tried first.
  absl::StatusOr<std::vector<DueWebhook>> Due(WallTime now, std::size_t per_owner, std::size_t most);
  // When the next one is, if there is one.
  absl::StatusOr<std::optional<WallTime>> NextDue();
  absl::Status Delivered(std::int64_t number, WallTime now) { return Finish(number, "", now); }
  absl::Status GiveUp(std::int64_t number, const std::string& error, WallTime now) {
    return Finish(number, error, now);
  }
  absl::Status TryAgain(std::int64_t number, const std::string& error, WallTime due);

  // As in webhook_secret_table.h.
  absl::StatusOr<std::vector<SecretTerm>> SecretsOf(const std::string& user, WallTime now);
  absl::StatusOr<std::vector<SecretTerm>> RotateSecretOf(const std::string& user, WallTime now,
                                                         std::chrono::milliseconds keep);
  // 32 bytes that nobody else knows, made at the first call and kept as long as the database.
  absl::StatusOr<std::string> Key();

 private:
  absl::Status Finish(std::int64_t number, const std::string& error, WallTime now);
  absl::Status Write(const std::function<absl::Status(Database&)>& work);

  std::mutex mutex_;
  const std::unique_ptr<Database> database_ ABSL_PT_GUARDED_BY(mutex_);
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_WEBHOOK_OUTBOX_H_
