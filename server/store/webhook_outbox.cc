// SPDX-License-Identifier: Apache-2.0
#include "server/store/webhook_outbox.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "server/store/random_bytes.h"
#include "server/store/webhook_table.h"

namespace flatlight {
namespace {

constexpr char kKeyName[] = "webhooks";
constexpr std::size_t kKeyBytes = 32;

std::int64_t Milliseconds(WallTime time) {
  return std::chrono::duration_cast<std::chrono::milliseconds>(time.time_since_epoch()).count();
}

WallTime TimeOf(std::int64_t milliseconds) { return WallTime(std::chrono::milliseconds(milliseconds)); }

}  // namespace

absl::Status WebhookOutbox::Write(const std::function<absl::Status(Database&)>& work) {
  const std::lock_guard lock(mutex_);
  Transaction transaction(*database_);
  if (absl::Status begun = transaction.Begin(); !begun.ok()) return begun;
  if (absl::Status done = work(*database_); !done.ok()) return done;
  return transaction.Commit();
}

absl::Status WebhookOutbox::Insert(const JobId& job, const std::string& owner, const std::string& url) {
  return Write([&](Database& database) { return InsertWebhook(database, job, owner, url); });
}

absl::Status WebhookOutbox::MakeDue(const JobId& job, const std::string& body) {
  return Write([&](Database& database) { return MakeWebhookDue(database, job, body).status(); });
}

absl::Status WebhookOutbox::Detach(const JobId& job) {
  return Write([&](Database& database) { return DetachWebhook(database, job); });
}

absl::StatusOr<std::optional<WebhookState>> WebhookOutbox::Of(const JobId& job) {
  const std::lock_guard lock(mutex_);
  Statement row = database_->Prepare(
      "SELECT url, attempts, error, due, due IS NULL, end_time, end_time IS NULL FROM webhooks WHERE job = ?");
  const auto found = row.Bind(std::string_view(job.uuid())).Step();
  if (!found.ok()) return found.status();
  if (!*found) return std::optional<WebhookState>();
  WebhookState state;
  state.url = row.Bytes(0);
  state.attempts = static_cast<unsigned>(row.Integer(1));
  state.error = row.Bytes(2);
  if (row.Integer(4) == 0) state.next_attempt = TimeOf(row.Integer(3));
  if (row.Integer(6) == 0) state.end_time = TimeOf(row.Integer(5));
  state.delivered = state.end_time.has_value() && state.error.empty();
  return std::optional(std::move(state));
}

absl::StatusOr<std::size_t> WebhookOutbox::OpenOf(const std::optional<std::string>& owner) {
  const std::lock_guard lock(mutex_);
  Statement count = database_->Prepare(std::string("SELECT count(*) FROM webhooks WHERE end_time IS NULL") +
                                       (owner ? " AND owner = ?" : ""));
  if (owner) count.Bind(std::string_view(*owner));
  if (const auto row = count.Step(); !row.ok()) return row.status();
  return static_cast<std::size_t>(count.Integer(0));
}

absl::StatusOr<std::vector<DueWebhook>> WebhookOutbox::Due(WallTime now, std::size_t per_owner, std::size_t most) {
  const std::lock_guard lock(mutex_);
  Statement rows = database_->Prepare(
      "SELECT number, job, owner, url, body, attempts FROM (SELECT *, row_number() OVER (PARTITION BY owner ORDER BY "
      "due, number) AS turn FROM webhooks WHERE due <= ?) WHERE turn <= ? ORDER BY due, number LIMIT ?");
  rows.Bind(Milliseconds(now)).Bind(static_cast<std::int64_t>(per_owner)).Bind(static_cast<std::int64_t>(most));
  std::vector<DueWebhook> due;
  absl::Status read = rows.ForEachRow([&](const Statement& row) {
    const auto job = JobId::FromName("jobs/" + row.Bytes(1));
    if (!job) return;
    due.push_back(
        {row.Integer(0), *job, row.Bytes(2), row.Bytes(3), row.Bytes(4), static_cast<unsigned>(row.Integer(5))});
  });
  if (!read.ok()) return read;
  return due;
}

absl::StatusOr<std::optional<WallTime>> WebhookOutbox::NextDue() {
  const std::lock_guard lock(mutex_);
  Statement next = database_->Prepare("SELECT due FROM webhooks WHERE due IS NOT NULL ORDER BY due LIMIT 1");
  const auto row = next.Step();
  if (!row.ok()) return row.status();
  if (!*row) return std::optional<WallTime>();
  return std::optional(TimeOf(next.Integer(0)));
}

absl::Status WebhookOutbox::Finish(std::int64_t number, const std::string& error, WallTime now) {
  return Write([&](Database& database) -> absl::Status {
    absl::Status removed =
        database.Prepare("DELETE FROM webhooks WHERE number = ? AND detached = 1").Bind(number).Run();
    if (!removed.ok()) return removed;
    return database
        .Prepare(
            "UPDATE webhooks SET due = NULL, body = NULL, error = ?, end_time = ?, attempts = attempts + 1 "
            "WHERE number = ?")
        .Bind(std::string_view(error))
        .Bind(Milliseconds(now))
        .Bind(number)
        .Run();
  });
}

absl::Status WebhookOutbox::TryAgain(std::int64_t number, const std::string& error, WallTime due) {
  return Write([&](Database& database) {
    return database.Prepare("UPDATE webhooks SET due = ?, error = ?, attempts = attempts + 1 WHERE number = ?")
        .Bind(Milliseconds(due))
        .Bind(std::string_view(error))
        .Bind(number)
        .Run();
  });
}

absl::StatusOr<std::vector<SecretTerm>> WebhookOutbox::SecretsOf(const std::string& user, WallTime now) {
  const std::lock_guard lock(mutex_);
  return ReadSecretTerms(*database_, user, now);
}

absl::StatusOr<std::vector<SecretTerm>> WebhookOutbox::RotateSecretOf(const std::string& user, WallTime now,
                                                                      std::chrono::milliseconds keep) {
  absl::Status rotated = Write([&](Database& database) { return RotateSecret(database, user, now, keep); });
  if (!rotated.ok()) return rotated;
  return SecretsOf(user, now);
}

absl::StatusOr<std::string> WebhookOutbox::Key() {
  std::string key;
  absl::Status done = Write([&](Database& database) -> absl::Status {
    const auto random = RandomBytes<kKeyBytes>();
    absl::Status made = database.Prepare("INSERT INTO secrets VALUES(?, ?) ON CONFLICT DO NOTHING")
                            .Bind(std::string_view(kKeyName))
                            .BindBlob({reinterpret_cast<const char*>(random.data()), random.size()})
                            .Run();
    if (!made.ok()) return made;
    Statement row = database.Prepare("SELECT value FROM secrets WHERE name = ?");
    const auto found = row.Bind(std::string_view(kKeyName)).Step();
    if (found.ok()) key = row.Bytes(0);
    return found.status();
  });
  if (!done.ok()) return done;
  return key;
}

}  // namespace flatlight
