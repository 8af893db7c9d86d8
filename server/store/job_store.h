// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_JOB_STORE_H_
#define FLATLIGHT_SERVER_STORE_JOB_STORE_H_

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/store/grants.h"
#include "server/store/job.h"

namespace flatlight {

// Names one call that makes something, so that a repeated call finds what the first one made.
struct RequestKey {
  std::string caller;
  std::string method;
  std::string request_id;
  std::string fingerprint;  // Of everything else in the request: the same id with another one is an error.
};

// How long it does.
inline constexpr std::chrono::hours kRequestMemory{24};

// What a job was made from, for a store that outlives the process: bytes that only their writer understands.
struct Submission {
  std::string request;
  std::string scene_sha256;                  // Of the uploaded file that the request names.
  std::shared_ptr<const std::string> scene;  // Its bytes; null: it names none.
  std::string webhook = {};                  // As JobSpec's.
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
  virtual absl::StatusOr<JobRecord> Insert(JobRecord job, const Submission& submission,
                                           const std::optional<RequestKey>& key) = 0;
  // A newer state of a job. NOT_FOUND if it was deleted.
  virtual absl::Status Update(const JobRecord& job) = 0;
  // The field of a job that has ended may be left out.
  virtual absl::StatusOr<JobRecord> Get(const JobId& id) = 0;
  virtual absl::StatusOr<JobRecord> GetWhole(const JobId& id) { return Get(id); }
  // Whether Get and what is told of the job's webhook come at once: without a look at the disk, which may take a while.
  virtual bool IsAtHand(const JobId& /*id*/) { return true; }
  // At most `limit` jobs of `owner`, or of all, from the newest one, or from the newest one older than `before`. As
  // many as that if there are so many. Fields may be left out.
  virtual absl::StatusOr<JobPage> List(const std::optional<std::string>& owner, std::optional<std::uint64_t> before,
                                       std::size_t limit) = 0;
  // The same, of jobs that are shared with one of `who` and are not `owner`'s.
  virtual absl::StatusOr<JobPage> ListShared(const std::vector<Grantee>& who, const std::string& owner,
                                             std::optional<std::uint64_t> before, std::size_t limit) = 0;
  virtual absl::Status Delete(const JobId& id) = 0;
  // Jobs of a class that ended before, those that ended first of all, without the first `skip` of these; at most
  // `limit`.
  virtual absl::StatusOr<std::vector<JobId>> EndedBefore(JobClass job_class, WallTime before, std::size_t skip,
                                                         std::size_t limit) = 0;

  // Who besides its owner may use a job. NOT_FOUND if there is no such job; else as AddGrant and RemoveGrant.
  virtual absl::Status Share(const JobId& id, const Grant& grant) = 0;
  virtual absl::Status Unshare(const JobId& id, const Grantee& grantee) = 0;
  // None, of a job that is not there.
  virtual absl::StatusOr<std::vector<Grant>> GrantsOf(const JobId& id) = 0;

  // The job that did the work of a key (JobSpec::work_key) last, and succeeded, also in a process before; nothing if
  // none is known.
  virtual std::optional<JobId> FindDone(const std::string& /*work_key*/) { return std::nullopt; }

  // How much room requests and results of an owner's jobs take; 0 where they end with the process.
  virtual std::uint64_t StoredBytesOf(const std::string& /*owner*/) { return 0; }

  // Of a store that outlives the process. An ended state is shown once it is written, or cannot be written for now.
  virtual bool durable() const { return false; }
  // Get, after an ended state that came by Update is shown.
  virtual absl::StatusOr<JobRecord> AwaitEnd(const JobId& id) { return Get(id); }
  // The result as it was written; null if it has not been.
  virtual absl::StatusOr<std::shared_ptr<const std::string>> WrittenResult(const JobId& /*id*/) { return nullptr; }
  // Of a store that outlives the process: writes whether the job is paused, as its newest state has it.
  virtual absl::Status SavePause(const JobId& /*id*/) { return absl::OkStatus(); }
  // Writes a checkpoint soon, on another thread, and tells how long it worked on it. s.
  virtual void SaveCheckpoint(const JobId& id, std::string checkpoint, std::function<void(double)> saved);
};

// NOT_FOUND.
absl::Status NoSuchJob(const JobId& id);
// ALREADY_EXISTS: the request of this id, with other contents, made `job`.
absl::Status RequestIdReused(const RequestKey& key, const JobId& job);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_JOB_STORE_H_
