// SPDX-License-Identifier: Apache-2.0
// Signatures of the Standard Webhooks specification, version 1 (HMAC-SHA256): a receiver that knows the secret knows
// that a message came from this server, as it is, and when.
#ifndef FLATLIGHT_SERVER_WEBHOOK_WEBHOOK_SIGNATURE_H_
#define FLATLIGHT_SERVER_WEBHOOK_WEBHOOK_SIGNATURE_H_

#include <cstdint>
#include <string>

namespace flatlight {

// Of the one event that a job has, its end: the same in every attempt, so that receivers know what they have had.
std::string WebhookId(const std::string& job_uuid);
// A user's own secret, 32 bytes, from the server's key: who has it can sign for that user's jobs alone, and knows no
// other generation. `generation`: SecretTerm.
std::string WebhookSecret(const std::string& key, const std::string& user, std::int64_t generation);
// As receivers are given it: "whsec_" and base64.
std::string WebhookSecretText(const std::string& secret);
// For the header webhook-signature, which has one or more, separated by spaces: "v1," and base64 of the HMAC of
// "id.timestamp.body". `timestamp`: s since 1970.
std::string WebhookSignature(const std::string& secret, const std::string& id, std::int64_t timestamp,
                             const std::string& body);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_WEBHOOK_WEBHOOK_SIGNATURE_H_
