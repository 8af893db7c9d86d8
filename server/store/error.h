// SPDX-License-Identifier: Apache-2.0
// Errors of the server: an absl::Status that also says, for programs, why (a reason in UPPER_SNAKE_CASE that never
// changes once published), and for exhausted limits which one and when to try again.
#ifndef FLATLIGHT_SERVER_STORE_ERROR_H_
#define FLATLIGHT_SERVER_STORE_ERROR_H_

#include <chrono>
#include <optional>
#include <string>

#include "absl/status/status.h"

namespace flatlight {

absl::Status MakeError(absl::StatusCode code, const std::string& reason, const std::string& message);

// UNAVAILABLE, DRAINING: of a server that ends. Another one may be there soon, so it says when to try again.
absl::Status MakeDrainingError();

// Of one's own: how much is used, and how much is allowed, in the limit's unit.
struct QuotaUse {
  double used = 0;
  double allowed = 0;
};

// RESOURCE_EXHAUSTED. `subject` names the limit ("max_jobs").
absl::Status MakeQuotaError(const std::string& reason, const std::string& subject, const std::string& message,
                            std::chrono::milliseconds retry_after, const std::optional<QuotaUse>& use = std::nullopt);

struct QuotaViolation {
  std::string subject;
  std::chrono::milliseconds retry_after{0};
  std::optional<QuotaUse> use = std::nullopt;
};

// Empty if the error was not made by the functions above.
std::string ReasonOf(const absl::Status& error);
// When to try again, of an error that says so; those of exhausted limits do.
std::optional<std::chrono::milliseconds> RetryAfterOf(const absl::Status& error);
std::optional<QuotaViolation> QuotaViolationOf(const absl::Status& error);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_ERROR_H_
