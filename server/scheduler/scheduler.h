// SPDX-License-Identifier: Apache-2.0
// Runs jobs in short slices, in turn, so that every job shows something soon and none holds up the rest.
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
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/execution/clock.h"
#include "core/execution/executor.h"
#include "core/render/rendering.h"
#include "server/scheduler/task_queue.h"
#include "server/store/job_store.h"

namespace flatlight {

struct SchedulerOptions {
  int runners = 1;                     // Slices at once. More than one keeps processors busy when jobs use few threads.
  int starters = 1;                    // Renderings prepared at once (acceleration structures), beside the slices.
  std::size_t max_running_jobs = 200;  // Later ones wait in the state QUEUED.
  Clock::Duration first_slice =
      std::chrono::milliseconds(5);  // Short: a picture soon, also when many jobs come at once.
  Clock::Duration slice = std::chrono::milliseconds(20);
  Clock::Duration publish_interval =
      std::chrono::milliseconds(40);  // Longer where a snapshot costs more than a tenth of it.
};

class Scheduler {
 public:
  using Start = std::function<std::unique_ptr<Rendering>(std::shared_ptr<const Scene>, const Plan&)>;
  // Told after each change of a job, from any thread, with no lock held. Must be quick and must not call back.
  using Listener = std::function<void(const JobId&)>;

  // What is passed in must outlive the scheduler.
  Scheduler(const SchedulerOptions& options, JobStore& store, Executor& executor, const Clock& clock, Start start,
            Listener listener);
  // As Stop.
  ~Scheduler();

  // Accepts a job and returns at once. The scene is let go when the job has ended. If `key` has made a job before,
  // returns that one.
  absl::StatusOr<JobRecord> Submit(std::shared_ptr<const JobSpec> spec, std::shared_ptr<const Scene> scene,
                                   const std::optional<RequestKey>& key);
  // Stops the work and returns the ended job, after at most one shard's time. An ended job stays as it is. What is
  // being prepared (for a million curves about a second's work) is prepared to its end, for nothing, after the job has
  // ended.
  absl::StatusOr<JobRecord> Cancel(const JobId& id);
  // Cancels and removes.
  absl::Status Delete(const JobId& id);
  // Cancels all jobs, refuses new ones, and waits until nothing works any more.
  void Stop();

 private:
  struct Run;
  using RunPtr = std::shared_ptr<Run>;

  void Admit() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void Prepare(const RunPtr& run);
  void RunSlices();
  RunPtr NextReady() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Returns whether it published a state.
  bool RunSlice(Run& run);
  // Stores the run's state under the next sequence number; the listener must be told afterwards.
  void Publish(Run& run) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void End(Run& run, JobPhase phase) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Asks a run to end; it has ended on return unless it is being sliced or waits for its last slice.
  void RequestCancel(Run& run) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const SchedulerOptions options_;
  JobStore& store_;
  Executor& executor_;
  const Clock& clock_;
  const Start start_;
  const Listener listener_;

  std::mutex mutex_;
  std::condition_variable ready_changed_;
  std::condition_variable run_ended_;
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;
  std::unordered_map<JobId, RunPtr> runs_ ABSL_GUARDED_BY(mutex_);  // Those that have not ended.
  std::deque<RunPtr> waiting_ ABSL_GUARDED_BY(mutex_);              // For one of max_running_jobs places.
  std::deque<RunPtr> urgent_ ABSL_GUARDED_BY(mutex_);               // To be ended: cancelled.
  std::deque<RunPtr> newcomers_ ABSL_GUARDED_BY(mutex_);            // Nothing to show yet.
  std::deque<RunPtr> ready_ ABSL_GUARDED_BY(mutex_);
  int newcomers_in_a_row_ ABSL_GUARDED_BY(mutex_) = 0;
  std::size_t running_ ABSL_GUARDED_BY(mutex_) = 0;
  std::unique_ptr<TaskQueue> starters_;
  std::vector<std::thread> runners_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SCHEDULER_SCHEDULER_H_
