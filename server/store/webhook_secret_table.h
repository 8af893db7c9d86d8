// SPDX-License-Identifier: Apache-2.0
// Which secrets a user's webhooks are signed with. The secrets themselves are in no table: WebhookSecret makes them.
#ifndef FLATLIGHT_SERVER_STORE_WEBHOOK_SECRET_TABLE_H_
#define FLATLIGHT_SERVER_STORE_WEBHOOK_SECRET_TABLE_H_

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/store/database.h"
#include "server/store/job.h"

namespace flatlight {

struct SecretTerm {
  std::int64_t generation = 0;               // Of the user's secrets, from 0 on; never used twice.
  std::optional<WallTime> expire_time = {};  // Until when messages are signed with it; nothing: it is the newest.
};

// Of secrets that were rotated and are used still, of one user.
inline constexpr std::size_t kMaxEarlierSecrets = 5;

// Those with which a message is signed now, the newest first.
absl::StatusOr<std::vector<SecretTerm>> ReadSecretTerms(Database& database, const std::string& user, WallTime now);
// A new secret for the user. All earlier ones are used for at most `keep` from now on. RESOURCE_EXHAUSTED with
// TOO_MANY_SECRETS if more than kMaxEarlierSecrets would be.
absl::Status RotateSecret(Database& database, const std::string& user, WallTime now, std::chrono::milliseconds keep);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_WEBHOOK_SECRET_TABLE_H_
