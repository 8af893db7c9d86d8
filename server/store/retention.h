// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_RETENTION_H_
#define FLATLIGHT_SERVER_STORE_RETENTION_H_

#include <array>
#include <chrono>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "server/store/job_class.h"

namespace flatlight {

// How long jobs that have ended are kept, by class; absent: for ever. Grades are kept until somebody says otherwise.
struct Retention {
  using WallTime = std::chrono::system_clock::time_point;

  std::array<std::optional<std::chrono::seconds>, kJobClasses> keep = {std::chrono::hours(24 * 30), std::nullopt,
                                                                       std::nullopt};

  // "interactive=7d", "graded=none": a whole number of s, m, h or d, at least one second. INVALID_ARGUMENT.
  absl::Status Set(const std::string& text);

  std::optional<std::chrono::seconds> Of(JobClass job_class) const { return keep[static_cast<std::size_t>(job_class)]; }
  // Of a job that ended then.
  std::optional<WallTime> ExpireTime(JobClass job_class, WallTime end) const {
    const auto kept = Of(job_class);
    return kept ? std::optional(end + *kept) : std::nullopt;
  }
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_RETENTION_H_
