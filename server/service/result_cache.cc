// SPDX-License-Identifier: Apache-2.0
#include "server/service/result_cache.h"

namespace flatlight {

ResultCache::Bytes ResultCache::Get(const JobId& job, const std::function<Bytes()>& make) {
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(results_, [](const auto& entry) { return entry.second.expired(); });
    if (const auto found = results_.find(job); found != results_.end()) {
      if (auto bytes = found->second.lock()) return bytes;
    }
  }
  auto bytes = make();
  if (!bytes.ok()) return bytes;
  const std::lock_guard lock(mutex_);
  results_[job] = *bytes;
  return bytes;
}

}  // namespace flatlight
