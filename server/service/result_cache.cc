// SPDX-License-Identifier: Apache-2.0
#include "server/service/result_cache.h"

#include "server/service/job_convert.h"

namespace flatlight {

absl::StatusOr<std::shared_ptr<const std::string>> ResultCache::Get(const JobRecord& job, const std::string& build) {
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(results_, [](const auto& entry) { return entry.second.expired(); });
    if (const auto found = results_.find(job.spec->id); found != results_.end()) {
      if (auto bytes = found->second.lock()) return bytes;
    }
  }
  const auto result = MakeResult(job, build);
  if (!result.ok()) return result.status();
  auto bytes = std::make_shared<const std::string>(result->SerializeAsString());
  const std::lock_guard lock(mutex_);
  results_[job.spec->id] = bytes;
  return bytes;
}

}  // namespace flatlight
