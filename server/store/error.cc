// SPDX-License-Identifier: Apache-2.0
#include "server/store/error.h"

#include <cstdlib>

#include "absl/strings/cord.h"

namespace flatlight {
namespace {

constexpr char kReason[] = "flatlight/reason";
constexpr char kQuotaSubject[] = "flatlight/quota-subject";
constexpr char kRetryMilliseconds[] = "flatlight/retry-milliseconds";
constexpr char kQuotaUsed[] = "flatlight/quota-used";
constexpr char kQuotaAllowed[] = "flatlight/quota-allowed";

constexpr std::chrono::milliseconds kUntilNextServer{2000};

std::string Payload(const absl::Status& error, const char* key) {
  const auto payload = error.GetPayload(key);
  return payload ? std::string(*payload) : std::string();
}

void SetRetryAfter(std::chrono::milliseconds time, absl::Status& error) {
  error.SetPayload(kRetryMilliseconds, absl::Cord(std::to_string(time.count())));
}

}  // namespace

absl::Status MakeError(absl::StatusCode code, const std::string& reason, const std::string& message) {
  absl::Status error(code, message);
  error.SetPayload(kReason, absl::Cord(reason));
  return error;
}

absl::Status MakeDrainingError() {
  absl::Status error =
      MakeError(absl::StatusCode::kUnavailable, "DRAINING", "the server is going down; try again later");
  SetRetryAfter(kUntilNextServer, error);
  return error;
}

absl::Status MakeQuotaError(const std::string& reason, const std::string& subject, const std::string& message,
                            std::chrono::milliseconds retry_after, const std::optional<QuotaUse>& use) {
  absl::Status error = MakeError(absl::StatusCode::kResourceExhausted, reason, message);
  error.SetPayload(kQuotaSubject, absl::Cord(subject));
  SetRetryAfter(retry_after, error);
  if (use) {
    error.SetPayload(kQuotaUsed, absl::Cord(std::to_string(use->used)));
    error.SetPayload(kQuotaAllowed, absl::Cord(std::to_string(use->allowed)));
  }
  return error;
}

std::string ReasonOf(const absl::Status& error) { return Payload(error, kReason); }

std::optional<std::chrono::milliseconds> RetryAfterOf(const absl::Status& error) {
  const std::string milliseconds = Payload(error, kRetryMilliseconds);
  if (milliseconds.empty()) return std::nullopt;
  return std::chrono::milliseconds(std::strtoll(milliseconds.c_str(), nullptr, 10));
}

std::optional<QuotaViolation> QuotaViolationOf(const absl::Status& error) {
  const std::string subject = Payload(error, kQuotaSubject);
  if (subject.empty()) return std::nullopt;
  QuotaViolation violation{subject, RetryAfterOf(error).value_or(std::chrono::milliseconds(0))};
  if (const std::string used = Payload(error, kQuotaUsed); !used.empty()) {
    violation.use = {std::strtod(used.c_str(), nullptr), std::strtod(Payload(error, kQuotaAllowed).c_str(), nullptr)};
  }
  return violation;
}

}  // namespace flatlight
