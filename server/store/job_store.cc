// SPDX-License-Identifier: Apache-2.0
#include "server/store/job_store.h"

#include "server/store/error.h"

namespace flatlight {

absl::Status NoSuchJob(const JobId& id) {
  return MakeError(absl::StatusCode::kNotFound, "JOB_NOT_FOUND", id.Name() + " does not exist or was deleted");
}

absl::Status RequestIdReused(const RequestKey& key, const JobId& job) {
  return MakeError(absl::StatusCode::kAlreadyExists, "REQUEST_ID_REUSED",
                   "request_id " + key.request_id + " was used for " + job.Name() +
                       " with other contents; use a new one for a new job");
}

// By value, for those that keep them.
// NOLINTNEXTLINE(performance-unnecessary-value-param)
void JobStore::SaveCheckpoint(const JobId& /*id*/, std::string /*checkpoint*/, std::function<void(double)> /*saved*/) {}

}  // namespace flatlight
