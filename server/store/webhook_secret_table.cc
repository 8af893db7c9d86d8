// SPDX-License-Identifier: Apache-2.0
#include "server/store/webhook_secret_table.h"

#include <string_view>

#include "server/store/error.h"

namespace flatlight {
namespace {

std::int64_t Milliseconds(WallTime time) {
  return std::chrono::duration_cast<std::chrono::milliseconds>(time.time_since_epoch()).count();
}

}  // namespace

absl::StatusOr<std::vector<SecretTerm>> ReadSecretTerms(Database& database, const std::string& user, WallTime now) {
  Statement rows = database.Prepare(
      "SELECT generation, expire_time, expire_time IS NULL FROM webhook_secrets WHERE user = ? AND "
      "(expire_time IS NULL OR expire_time > ?) ORDER BY generation DESC");
  rows.Bind(std::string_view(user)).Bind(Milliseconds(now));
  std::vector<SecretTerm> terms;
  absl::Status read = rows.ForEachRow([&](const Statement& row) {
    terms.push_back({row.Integer(0), {}});
    if (row.Integer(2) == 0) terms.back().expire_time = WallTime(std::chrono::milliseconds(row.Integer(1)));
  });
  if (!read.ok()) return read;
  if (terms.empty()) terms.push_back({0, {}});
  return terms;
}

absl::Status RotateSecret(Database& database, const std::string& user, WallTime now, std::chrono::milliseconds keep) {
  const auto terms = ReadSecretTerms(database, user, now);
  if (!terms.ok()) return terms.status();
  if (keep > std::chrono::milliseconds(0) && terms->size() > kMaxEarlierSecrets) {
    const auto first_end = std::chrono::ceil<std::chrono::milliseconds>(*terms->back().expire_time - now);
    return MakeQuotaError("TOO_MANY_SECRETS", "max_earlier_webhook_secrets",
                          std::to_string(terms->size() - 1) + " earlier secrets are used still; allowed: " +
                              std::to_string(kMaxEarlierSecrets) + "; wait, or keep none of them (0 s)",
                          first_end);
  }
  const std::int64_t newest = terms->front().generation;
  absl::Status known = database.Prepare("INSERT INTO webhook_secrets VALUES(?, ?, NULL) ON CONFLICT DO NOTHING")
                           .Bind(std::string_view(user))
                           .Bind(newest)
                           .Run();
  if (!known.ok()) return known;
  const std::int64_t until = Milliseconds(now + keep);
  absl::Status ended = database
                           .Prepare(
                               "UPDATE webhook_secrets SET expire_time = min(coalesce(expire_time, ?), ?) "
                               "WHERE user = ?")
                           .Bind(until)
                           .Bind(until)
                           .Bind(std::string_view(user))
                           .Run();
  if (!ended.ok()) return ended;
  absl::Status dropped = database.Prepare("DELETE FROM webhook_secrets WHERE user = ? AND expire_time <= ?")
                             .Bind(std::string_view(user))
                             .Bind(Milliseconds(now))
                             .Run();
  if (!dropped.ok()) return dropped;
  return database.Prepare("INSERT INTO webhook_secrets VALUES(?, ?, NULL)")
      .Bind(std::string_view(user))
      .Bind(newest + 1)
      .Run();
}

}  // namespace flatlight
