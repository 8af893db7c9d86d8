// SPDX-License-Identifier: Apache-2.0
// Runs jobs in short slices, so that every job shows something soon and none holds up the rest. Whose turn it is is
// decided by class, then by who has attained least (FairQueue, Accounts): a thousand jobs of one user delay the first
// picture of another's by a slice.
#ifndef FLATLIGHT_SERVER_SCHEDULER_SCHEDULER_H_
#define FLATLIGHT_SERVER_SCHEDULER_SCHEDULER_H_

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/execution/clock.h"
#include "core/execution/executor.h"
#include "core/render/rendering.h"
#include "server/quota/cpu_ledger.h"
#include "server/quota/quotas.h"
#include "server/scheduler/accounts.h"
#include "server/scheduler/admission_pace.h"
#include "server/scheduler/fair_queue.h"
#include "server/scheduler/job_checkpoint.h"
#include "server/scheduler/job_run.h"
#include "server/scheduler/scheduler_events.h"
#include "server/scheduler/shared_work.h"
#include "server/scheduler/task_queue.h"
#include "server/store/job_store.h"
#include "server/store/retention.h"

namespace flatlight {

struct SchedulerOptions {
  int runners = 1;   // Slices at once. More than one keeps processors busy when jobs use few threads.
  int starters = 1;  // Renderings prepared at once (acceleration structures), beside the slices.
  // Places. Later jobs wait in the state QUEUED, and so do those of a user whose jobs of the same or a more urgent
  // class hold as many places as are free: there is always one for who comes anew, and for a picture beside one's own
  // regrading (dynamic thresholds: Choudhury, Hahne 1998). Paused jobs keep theirs.
  std::size_t max_running_jobs = 200;
  Clock::Duration queue_interval = std::chrono::seconds(1);  // Between what a waiting job is told of its place.
  Clock::Duration first_slice =
      std::chrono::milliseconds(5);  // Short: a picture soon, also when many jobs come at once.
  Clock::Duration slice = std::chrono::milliseconds(20);
  Clock::Duration publish_interval =
      std::chrono::milliseconds(40);  // Longer where a snapshot costs more than a tenth of it.
  // Of one job; longer where they would cost more than a hundredth of its processor time.
  Clock::Duration checkpoint_interval = std::chrono::seconds(3);
  Retention retention;                // Of jobs that have ended: their states tell when they expire.
  SchedulerEvents* events = nullptr;  // Who is told of the work; outlives the scheduler.
  CpuLedger* ledger = nullptr;        // Of what owners have had today; outlives the scheduler. Null: nobody counts.
  Clock::Duration day_interval = std::chrono::seconds(1);  // Between looks whether another day has begun.
};

class Scheduler {
 public:
  using Start = std::function<std::unique_ptr<Rendering>(std::shared_ptr<const Scene>, const JobSpec&)>;
  // Told after each change of a job, from any thread, with no lock held. Must be quick and must not call back.
  using Listener = std::function<void(const JobId&)>;

  // What is passed in must outlive the scheduler.
  Scheduler(const SchedulerOptions& options, JobStore& store, Executor& executor, const Clock& clock, Start start,
            Listener listener);
  // As Stop.
  ~Scheduler();

  // Accepts a job and returns at once. The scene is let go when the job has ended. If `key` has made a job before,
  // returns that one. `quotas` are its owner's, from now on.
  // RESOURCE_EXHAUSTED if the owner has too many jobs that have not ended, or has used up today's processor time.
  absl::StatusOr<JobRecord> Submit(std::shared_ptr<const JobSpec> spec, std::shared_ptr<const Scene> scene,
                                   const Submission& submission, const std::optional<RequestKey>& key,
                                   const Quotas& quotas = {});
  // Accepts a job that the store has restored; `restore` is called when its turn comes. An error of it ends the job.
  void Resubmit(const JobRecord& job, JobRun::Restore restore, const Quotas& quotas = {});
  // Stops the work and returns the ended job, after at most one shard's time. An ended job stays as it is. What is
  // being prepared (for a million curves about a second's work) is prepared to its end, for nothing, after the job has
  // ended.
  absl::StatusOr<JobRecord> Cancel(const JobId& id);
  // Does not wait for the end. Nothing happens to a job that has ended.
  void RequestCancel(const JobId& id);
  // No slice of the job runs after the return, until Resume; its time stands still. FAILED_PRECONDITION if it has
  // ended.
  absl::StatusOr<JobRecord> Pause(const JobId& id);
  absl::StatusOr<JobRecord> Resume(const JobId& id);
  // Cancels and removes.
  absl::Status Delete(const JobId& id);
  SchedulerLoad Load();
  // How many jobs of an owner have not ended.
  std::size_t JobsOf(const std::string& owner);
  // Of those that have not ended, at most so many: those with a place, that wait, that rest; the oldest first.
  std::vector<JobId> Unended(std::size_t most);
  // Refuses new jobs, and waits until nothing works any more. Jobs of a durable store are left as they are, with a
  // checkpoint; others are cancelled.
  void Stop();

 private:
  using RunPtr = std::shared_ptr<JobRun>;

  struct Owner {
    std::size_t jobs = 0;  // Of `runs_`, and those that are just being submitted.
    Quotas quotas;
  };

  absl::Status CheckQuota(const std::string& owner, const Quotas& quotas) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Gives free places to those who wait. To be called after each change of places or of what waits.
  void Admit() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // `done`: what its work comes to, if that is known.
  void Enter(const RunPtr& run, const JobState* done) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Of one that waits for nothing yet: to whom does the same work, or to those who wait for a place.
  void FollowOrWait(const RunPtr& run) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // The other's values, as of now, as its own.
  void Adopt(const JobState& other, JobRun& run) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // In stage kFollowing: into the stage kWaiting, with the values that it has, but waiting for nothing yet.
  void Unfollow(JobRun& run) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Those who follow a run that rests or has ended in vain: each as if it came now.
  void SendAway(JobRun& leader) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // What another job found that did the same work to its end; null if there is none, or it is no longer at hand.
  std::shared_ptr<const JobState> StateOfDone(const JobSpec& spec) ABSL_LOCKS_EXCLUDED(mutex_);
  void FreeQuota(const std::string& owner) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Of processor time that was spent for a job: to whom it is due.
  void Charge(const std::string& owner, double cpu_seconds) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Whether the owner has used up today's processor time: its jobs keep their places, and get no turns until tomorrow.
  bool IsSpent(const std::string& owner) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    return !spent_.empty() && spent_.count(owner) > 0;
  }
  // `used` today, s. With a ledger.
  void CheckDay(const std::string& owner, double used) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // In stage kReady, of a spent owner: says so, and lets go of those who wait for its values.
  void EnterRest(JobRun& run) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void LeaveRest(const std::function<bool(const std::string& owner)>& whose) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // If another day has begun, all go on. Returns whether that is so.
  bool MaybeBeginDay() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void TellPlaces() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void PrepareNext();
  void RunSlices();
  RunPtr NextReady() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void RunSlice(JobRun& run);
  std::unique_ptr<Rendering> StartOrResume(const JobSpec& spec, const std::shared_ptr<const Scene>& scene,
                                           const std::optional<JobCheckpoint>& checkpoint) const;
  // Writes down how far a job is, if it is time: between two slices of it.
  void MaybeCheckpoint(const RunPtr& run, double cpu_seconds);
  void SaveCheckpoint(const RunPtr& run, std::size_t most_bytes);
  // When the server goes down: the job is left to the next one.
  bool LeavesJobs() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) { return stopping_ && store_.durable(); }
  void Suspend(JobRun& run) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // After its preparation or a slice: to the queue in which it waits for the next one.
  void Requeue(const RunPtr& run) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Stores the run's state under the next sequence number, for TellListener.
  void Publish(JobRun& run) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void Store(const JobRun& run) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Of all that was published and not yet told.
  void TellListener() ABSL_LOCKS_EXCLUDED(mutex_);
  void End(JobRun& run, JobPhase phase) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Asks a run to end; it has ended on return unless it is being sliced or waits for its last slice.
  void RequestCancel(const RunPtr& run) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void EnterPause(JobRun& run) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  RunPtr Find(const JobId& id) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const SchedulerOptions options_;
  JobStore& store_;
  Executor& executor_;
  const Clock& clock_;
  const Start start_;
  const Listener listener_;

  std::mutex mutex_;
  std::condition_variable ready_changed_;
  std::condition_variable run_stopped_;  // One has ended or been paused.
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;
  std::unordered_map<JobId, RunPtr> runs_ ABSL_GUARDED_BY(mutex_);  // Those that have not ended.
  std::unordered_map<std::string, Owner> owners_ ABSL_GUARDED_BY(mutex_);
  std::unordered_set<std::string> spent_ ABSL_GUARDED_BY(mutex_);  // Owners who have used up `spent_day_`.
  std::int64_t spent_day_ ABSL_GUARDED_BY(mutex_) = 0;
  Accounts accounts_ ABSL_GUARDED_BY(mutex_);
  SharedWork shared_work_ ABSL_GUARDED_BY(mutex_){10'000};
  FairQueue<RunPtr> waiting_ ABSL_GUARDED_BY(mutex_);    // For one of max_running_jobs places.
  FairQueue<RunPtr> preparing_ ABSL_GUARDED_BY(mutex_);  // For a starter. Those that have ended are passed over.
  FairQueue<RunPtr> ready_ ABSL_GUARDED_BY(mutex_);      // For a slice.
  std::deque<RunPtr> urgent_ ABSL_GUARDED_BY(mutex_);    // To be ended: cancelled.
  AdmissionPace pace_ ABSL_GUARDED_BY(mutex_);
  std::optional<Clock::Time> places_told_ ABSL_GUARDED_BY(mutex_);
  std::vector<JobId> untold_ ABSL_GUARDED_BY(mutex_);
  std::unique_ptr<TaskQueue> starters_;
  std::vector<std::thread> runners_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SCHEDULER_SCHEDULER_H_
