// SPDX-License-Identifier: Apache-2.0
#include "server/store/webhook_table.h"

#include <string_view>

namespace flatlight {

absl::Status InsertWebhook(Database& database, const JobId& job, const std::string& owner, const std::string& url) {
  return database.Prepare("INSERT INTO webhooks(job, owner, url) VALUES(?, ?, ?)")
      .Bind(std::string_view(job.uuid()))
      .Bind(std::string_view(owner))
      .Bind(std::string_view(url))
      .Run();
}

absl::StatusOr<bool> MakeWebhookDue(Database& database, const JobId& job, const std::string& body) {
  // 0 is before any time that a clock may be set to: a first attempt never waits for one.
  absl::Status written =
      database.Prepare("UPDATE webhooks SET due = 0, body = ? WHERE job = ? AND end_time IS NULL AND body IS NULL")
          .Bind(std::string_view(body))
          .Bind(std::string_view(job.uuid()))
          .Run();
  if (!written.ok()) return written;
  return database.changed_rows() > 0;
}

absl::Status DetachWebhook(Database& database, const JobId& job) {
  absl::Status removed =
      database.Prepare("DELETE FROM webhooks WHERE job = ? AND due IS NULL").Bind(std::string_view(job.uuid())).Run();
  if (!removed.ok()) return removed;
  return database.Prepare("UPDATE webhooks SET detached = 1 WHERE job = ?").Bind(std::string_view(job.uuid())).Run();
}

}  // namespace flatlight
