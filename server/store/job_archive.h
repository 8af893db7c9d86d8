// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_JOB_ARCHIVE_H_
#define FLATLIGHT_SERVER_STORE_JOB_ARCHIVE_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/store/job_id.h"
#include "server/store/job_store.h"
#include "server/store/storage.h"
#include "server/store/stored_bytes.h"

namespace flatlight {

// A job as it is written: bytes that only their writer understands.
struct ArchivedJob {
  JobId id;
  std::string owner;
  std::string message;                // As it was accepted, or as it ended.
  std::uint64_t sequence = 0;         // Of that state; 0: it has not ended.
  std::optional<std::string> result;  // The hash of it.
  bool paused = false;                // Of one that has not ended.
  bool ended() const { return sequence > 0; }
};

// What a job comes to.
struct JobEnd {
  std::string message;
  std::uint64_t sequence = 1;              // Of that state, > 0.
  std::optional<std::string> result = {};  // Its bytes.
  WallTime time = {};
  JobClass job_class = JobClass::kInteractive;
  std::string event = {};     // For its webhook, if it has one.
  std::string work_key = {};  // JobSpec's, if its values are all that such work comes to.
};

// Jobs on disk. Each change is committed when the call returns, and has not happened if it returns an error. Safe to
// use from any thread.
class JobArchive {
 public:
  JobArchive(Storage& storage, std::string build)
      : storage_(storage), build_(std::move(build)), stored_bytes_(MeasureStoredBytes(storage)) {}

  // As JobStore's.
  absl::StatusOr<std::optional<JobId>> FindRequest(const RequestKey& key, WallTime now);
  // Returns the id of the job that the same request made before, if there is one, else that of the new one.
  absl::StatusOr<JobId> Insert(const JobId& id, const std::string& owner, std::string message,
                               const Submission& submission, const std::optional<RequestKey>& key, WallTime now);
  // Replaces the one before.
  absl::Status SaveCheckpoint(const JobId& id, std::string checkpoint);
  // Whether a job that has not ended is paused. Nothing happens to one that has ended, or is gone.
  absl::Status SavePause(const JobId& id, bool paused);
  // The last change of a job: nothing remains but message and result.
  absl::Status End(const JobId& id, JobEnd end);
  // `due` is called after each end that a webhook is to be told of. To be called once, first.
  void WhenWebhookIsDue(std::function<void()> due) { webhook_due_ = std::move(due); }
  absl::Status Delete(const JobId& id);
  absl::Status Share(const JobId& id, const Grant& grant);
  absl::Status Unshare(const JobId& id, const Grantee& grantee);
  absl::StatusOr<std::vector<Grant>> GrantsOf(const JobId& id);
  // As JobStore's. Jobs without a class are not among them.
  absl::StatusOr<std::vector<JobId>> EndedBefore(JobClass job_class, WallTime before, std::size_t skip,
                                                 std::size_t limit);
  // The job that did the work of a key last; nothing if there is none.
  absl::StatusOr<std::optional<JobId>> FindDone(const std::string& work_key);
  // Jobs that ended under a Flatlight that wrote no classes, at most so many; and writes what they are.
  absl::StatusOr<std::vector<ArchivedJob>> WithoutClass(std::size_t limit);
  absl::Status Classify(const std::vector<std::pair<JobId, JobClass>>& classes);
  // Forgets requests made before.
  absl::Status DropRequests(WallTime before);

  // NOT_FOUND if there is none.
  absl::StatusOr<ArchivedJob> Get(const JobId& id);
  struct Page {
    std::vector<ArchivedJob> jobs;
    std::vector<std::uint64_t> positions;
    std::optional<std::uint64_t> next_before;
  };
  absl::StatusOr<Page> List(const std::optional<std::string>& owner, std::optional<std::uint64_t> before,
                            std::size_t limit);
  absl::StatusOr<Page> ListShared(const std::vector<Grantee>& who, const std::string& owner,
                                  std::optional<std::uint64_t> before, std::size_t limit);
  absl::StatusOr<std::vector<ArchivedJob>> Unfinished();  // Oldest first.
  // Of requests and results of an owner's jobs. From memory.
  std::uint64_t StoredBytesOf(const std::string& owner);

  absl::StatusOr<std::string> Fetch(const std::string& sha256) { return storage_.Fetch(sha256); }
  // Of a job that has not ended.
  absl::StatusOr<Submission> FetchSubmission(const JobId& id);
  absl::StatusOr<std::optional<std::string>> FetchCheckpoint(const JobId& id);

 private:
  // Of jobs whose grants are remembered, as every call asks for them; then all are forgotten.
  static constexpr std::size_t kMostGranted = 10'000;

  void AddStoredBytes(const std::string& owner, std::int64_t bytes);

  Storage& storage_;
  const std::string build_;
  std::function<void()> webhook_due_ = [] {};
  std::mutex stored_mutex_;
  StoredBytes stored_bytes_ ABSL_GUARDED_BY(stored_mutex_);
  std::mutex grants_mutex_;
  std::unordered_map<JobId, std::vector<Grant>> grants_ ABSL_GUARDED_BY(grants_mutex_);
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_JOB_ARCHIVE_H_
