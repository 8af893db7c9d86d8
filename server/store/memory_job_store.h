// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_MEMORY_JOB_STORE_H_
#define FLATLIGHT_SERVER_STORE_MEMORY_JOB_STORE_H_

#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "core/execution/clock.h"
#include "server/store/job_format.h"
#include "server/store/job_store.h"
#include "server/store/webhook_outbox.h"

namespace flatlight {

// Jobs that live as long as the process.
class MemoryJobStore final : public JobStore {
 public:
  struct Limits {
    std::size_t max_jobs = 10'000;
    double max_bytes = 4e9;        // Of scenes and fields of all jobs, estimated.
    double max_ended_bytes = 1e9;  // Of the results of jobs that have ended, estimated.
    std::size_t max_requests = 100'000;
  };
  // Where webhooks of its jobs are kept, what they are told, and who is told that one is due.
  struct Webhooks {
    WebhookOutbox& outbox;
    const JobFormat& format;
    std::function<void()> due;
  };
  // What is passed in must outlive the store.
  MemoryJobStore(const Limits& limits, const Clock& clock, std::optional<Webhooks> webhooks = std::nullopt)
      : limits_(limits), clock_(clock), webhooks_(std::move(webhooks)) {}

  absl::StatusOr<std::optional<JobId>> FindRequest(const RequestKey& key) override;
  absl::StatusOr<JobRecord> Insert(JobRecord job, const Submission& submission,
                                   const std::optional<RequestKey>& key) override;
  absl::Status Update(const JobRecord& job) override;
  absl::StatusOr<JobRecord> Get(const JobId& id) override;
  absl::StatusOr<JobPage> List(const std::optional<std::string>& owner, std::optional<std::uint64_t> before,
                               std::size_t limit) override;
  absl::StatusOr<JobPage> ListShared(const std::vector<Grantee>& who, const std::string& owner,
                                     std::optional<std::uint64_t> before, std::size_t limit) override;
  absl::Status Delete(const JobId& id) override;
  absl::StatusOr<std::vector<JobId>> EndedBefore(JobClass job_class, WallTime before, std::size_t skip,
                                                 std::size_t limit) override;
  absl::Status Share(const JobId& id, const Grant& grant) override;
  absl::Status Unshare(const JobId& id, const Grantee& grantee) override;
  absl::StatusOr<std::vector<Grant>> GrantsOf(const JobId& id) override;

 private:
  struct Request {
    std::string fingerprint;
    JobId job;
  };
  using Name = std::tuple<std::string, std::string, std::string>;  // Caller, method, request id.

  absl::StatusOr<std::optional<JobId>> FindRequestLocked(const RequestKey& key) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // What is kept of a job, and what for.
  struct Entry {
    JobRecord job;
    double bytes = 0;
    std::uint64_t end = 0;  // Its place in `ended_`; 0: it has not ended.
    std::vector<Grant> grants = {};
  };

  JobPage ListIf(std::optional<std::uint64_t> before, std::size_t limit,
                 const std::function<bool(const Entry&)>& wanted) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  Entry* Find(const JobId& id) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  absl::Status MakeRoom(double bytes) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Notes that a job holds only its result from now on. Drops the results that ended longest ago if there are too many.
  void NoteEnd(std::uint64_t number, Entry& entry) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void Erase(std::uint64_t number) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const Limits limits_;
  const Clock& clock_;
  const std::optional<Webhooks> webhooks_;
  std::mutex mutex_;
  std::uint64_t next_number_ ABSL_GUARDED_BY(mutex_) = 1;
  double bytes_ ABSL_GUARDED_BY(mutex_) = 0;
  double ended_bytes_ ABSL_GUARDED_BY(mutex_) = 0;
  std::uint64_t next_end_ ABSL_GUARDED_BY(mutex_) = 1;
  std::map<std::uint64_t, Entry> jobs_ ABSL_GUARDED_BY(mutex_);           // By number: in order of creation.
  std::map<std::uint64_t, std::uint64_t> ended_ ABSL_GUARDED_BY(mutex_);  // Numbers, in the order of their ends.
  std::unordered_map<JobId, std::uint64_t> numbers_ ABSL_GUARDED_BY(mutex_);
  std::map<Name, Request> requests_ ABSL_GUARDED_BY(mutex_);
  std::deque<std::pair<Clock::Time, Name>> request_ages_ ABSL_GUARDED_BY(mutex_);  // Oldest first.
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_MEMORY_JOB_STORE_H_
