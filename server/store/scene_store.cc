// SPDX-License-Identifier: Apache-2.0
#include "server/store/scene_store.h"

#include <chrono>

#include "server/store/error.h"

namespace flatlight {

absl::Status NoSuchScene(const std::string& sha256) {
  return MakeError(absl::StatusCode::kNotFound, "SCENE_NOT_FOUND", "scenes/" + sha256 + " does not exist");
}

absl::Status StorageUsedUp(std::uint64_t used, std::uint64_t allowed, std::uint64_t more) {
  // Nothing frees room by itself but the age of jobs.
  constexpr std::chrono::minutes kRetryAfter{1};
  const std::string wanted = more > 0 ? ", and " + std::to_string(more) + " more are wanted" : "";
  return MakeQuotaError("STORAGE_USED_UP", "max_storage_bytes_per_user",
                        "your scenes and jobs hold " + std::to_string(used) + " bytes" + wanted +
                            "; allowed: " + std::to_string(allowed) + ". Delete some of them first",
                        kRetryAfter, QuotaUse{static_cast<double>(used), static_cast<double>(allowed)});
}

}  // namespace flatlight
