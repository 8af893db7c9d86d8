// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_DURABLE_JOB_STORE_H_
#define FLATLIGHT_SERVER_STORE_DURABLE_JOB_STORE_H_

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "core/execution/clock.h"
#include "server/store/job_archive.h"
#include "server/store/job_format.h"
#include "server/store/memory_job_store.h"

namespace flatlight {

// Jobs that outlive the process. Those that have not ended are held in memory, as are some that have; all are in an
// archive: a job before Insert returns, its end before anybody sees it. If the end cannot be written (a full disk), it
// is shown and held in memory, and the writing is tried again.
class DurableJobStore final : public JobStore {
 public:
  struct Options {
    MemoryJobStore::Limits memory;
    std::chrono::milliseconds retry{2000};
  };
  // What is passed in must outlive the store. With no lock held, `ended` is told of jobs whose end is shown from now
  // on, and `health` when writing begins to fail (the error) and when it works again.
  DurableJobStore(const Options& options, const Clock& clock, JobArchive& archive, const JobFormat& format,
                  std::function<void(const JobId&)> ended, std::function<void(const absl::Status&)> health);
  // As Close.
  ~DurableJobStore() override;
  // Writes what is to be written, as far as it can be; no jobs must end, and no checkpoints come, from then on.
  void Close();

  // The jobs that had not ended when the process before did, oldest first: QUEUED or PAUSED, at sequence 0, and from
  // now on in this store. To be called once, first.
  absl::StatusOr<std::vector<JobRecord>> Restore();

  absl::StatusOr<std::optional<JobId>> FindRequest(const RequestKey& key) override;
  absl::StatusOr<JobRecord> Insert(JobRecord job, const Submission& submission,
                                   const std::optional<RequestKey>& key) override;
  absl::Status Update(const JobRecord& job) override;
  absl::StatusOr<JobRecord> Get(const JobId& id) override;
  bool IsAtHand(const JobId& id) override {
    const auto job = memory_.Get(id);
    return job.ok() && job->spec->webhook.empty();
  }
  absl::StatusOr<JobRecord> GetWhole(const JobId& id) override;
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
  std::uint64_t StoredBytesOf(const std::string& owner) override { return archive_.StoredBytesOf(owner); }
  bool durable() const override { return true; }
  std::optional<JobId> FindDone(const std::string& work_key) override {
    return archive_.FindDone(work_key).value_or(std::nullopt);
  }
  absl::StatusOr<JobRecord> AwaitEnd(const JobId& id) override;
  absl::StatusOr<std::shared_ptr<const std::string>> WrittenResult(const JobId& id) override;
  absl::Status SavePause(const JobId& id) override;
  void SaveCheckpoint(const JobId& id, std::string checkpoint, std::function<void(double)> saved) override;

 private:
  struct Checkpoint {
    JobId id;
    std::string bytes;
    std::function<void(double)> saved;
  };
  struct End {
    JobRecord job;
    bool shown = false;
  };

  void Work();
  // Returns whether it did not fail.
  bool WriteEnd(std::unique_lock<std::mutex>& lock, const JobId& id) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void NoteHealth(const absl::Status& written);
  void WriteCheckpoint(std::unique_lock<std::mutex>& lock) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::StatusOr<JobPage> PageOf(absl::StatusOr<JobArchive::Page> archived);
  // Of jobs that an earlier Flatlight wrote without their class.
  absl::Status ClassifySome();
  // From the archive.
  absl::StatusOr<JobRecord> Read(const JobId& id, bool whole);
  absl::StatusOr<JobRecord> Find(const JobId& id, bool whole);

  const Options options_;
  MemoryJobStore memory_;
  JobArchive& archive_;
  const JobFormat& format_;
  const std::function<void(const JobId&)> ended_;
  const std::function<void(const absl::Status&)> tell_health_;

  std::mutex pausing_;  // One after the other reads a job's state and writes it, so that the newest one stays.
  std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable shown_;
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;
  bool healthy_ ABSL_GUARDED_BY(mutex_) = true;                       // As was told last.
  std::unordered_map<JobId, End> unwritten_ ABSL_GUARDED_BY(mutex_);  // Ends that are not in the archive yet.
  std::deque<JobId> ends_ ABSL_GUARDED_BY(mutex_);                    // The same, in their order.
  std::deque<Checkpoint> checkpoints_ ABSL_GUARDED_BY(mutex_);
  std::thread writer_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_DURABLE_JOB_STORE_H_
