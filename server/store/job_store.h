// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_JOB_STORE_H_
#define FLATLIGHT_SERVER_STORE_JOB_STORE_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/store/job.h"

namespace flatlight {

// Names one call that makes something, so that a repeated call finds what the first one made.
struct RequestKey {
  std::string caller;
  std::string method;
  std::string request_id;
  std::string fingerprint;  // Of everything else in the request: the same id with another one is an error.
};

struct JobPage {
  std::vector<JobRecord> jobs;               // Newest first.
  std::vector<std::uint64_t> positions;      // Of each: `before` for a page that begins after it.
  std::optional<std::uint64_t> next_before;  // Where the next page begins; absent on the last page.
};

// Jobs, by id, and which request made which. Safe to use from any thread.
class JobStore {
 public:
  virtual ~JobStore() = default;

  // The id of the job that an earlier request of this key made (within 24 h); nothing if there was none.
  // ALREADY_EXISTS if the fingerprints differ.
  virtual absl::StatusOr<std::optional<JobId>> FindRequest(const RequestKey& key) = 0;
  // Adds a job, unless `key` has made one meanwhile, which is then returned. Drops ended jobs, oldest first, to make
  // room; RESOURCE_EXHAUSTED if that is not enough.
  virtual absl::StatusOr<JobRecord> Insert(JobRecord job, const std::optional<RequestKey>& key) = 0;
  // NOT_FOUND if the job was deleted.
  virtual absl::Status Update(const JobId& id, std::shared_ptr<const JobState> state) = 0;
  virtual absl::StatusOr<JobRecord> Get(const JobId& id) = 0;
  // At most `limit` jobs, from the newest one, or from the newest one older than `before`.
  virtual JobPage List(std::optional<std::uint64_t> before, std::size_t limit) = 0;
  virtual absl::Status Delete(const JobId& id) = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_JOB_STORE_H_
