// SPDX-License-Identifier: Apache-2.0
// How much of a server each user may have, by role.
#ifndef FLATLIGHT_SERVER_QUOTA_QUOTAS_H_
#define FLATLIGHT_SERVER_QUOTA_QUOTAS_H_

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "server/store/user_store.h"

namespace flatlight {

// Of one user; absent: no limit but the server's own.
struct Quotas {
  std::optional<std::uint32_t> jobs = {};           // That have not ended.
  std::optional<double> cpu_seconds = {};           // Processor time for jobs, in a day of UTC.
  std::optional<std::uint32_t> watches = {};        // At once, of jobs and rooms.
  std::optional<std::uint64_t> storage_bytes = {};  // Of uploaded scenes, and of requests and results of jobs.
  std::optional<double> requests = {};              // A second, in the long run.
};

// So many requests at once, after a rest: ten seconds' worth, and at least one, as less often than that must do too.
inline double RequestsAtOnce(double a_second) {
  constexpr double kBurstSeconds = 10;
  return std::max(1.0, a_second * kBurstSeconds);
}

class QuotaTable {
 public:
  QuotaTable();  // The defaults.

  const Quotas& Of(Role role) const { return quotas_[static_cast<std::size_t>(role)]; }

  // "ROLE.LIMIT=VALUE", such as "student.jobs=50" or "grader.requests=none". INVALID_ARGUMENT says what is allowed.
  absl::Status Set(std::string_view text);

 private:
  std::array<Quotas, kRoles> quotas_;
};

// The names of limits as Set takes them, in the order of Quotas: "jobs, ...".
std::string QuotaNames();

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_QUOTA_QUOTAS_H_
