// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_RESULT_CACHE_H_
#define FLATLIGHT_SERVER_SERVICE_RESULT_CACHE_H_

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "server/store/job_id.h"

namespace flatlight {

// Serialised results of ended jobs, shared by those who read one at the same time, and kept no longer.
class ResultCache {
 public:
  using Bytes = absl::StatusOr<std::shared_ptr<const std::string>>;
  // `make` is called if nobody reads the result now.
  Bytes Get(const JobId& job, const std::function<Bytes()>& make);

 private:
  std::mutex mutex_;
  std::unordered_map<JobId, std::weak_ptr<const std::string>> results_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_RESULT_CACHE_H_
