// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SCHEDULER_JOB_RUN_H_
#define FLATLIGHT_SERVER_SCHEDULER_JOB_RUN_H_

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/execution/cancellation.h"
#include "core/execution/clock.h"
#include "core/render/rendering.h"
#include "core/scene/scene.h"
#include "server/scheduler/fair_queue.h"
#include "server/scheduler/stopwatch.h"
#include "server/store/job.h"

namespace flatlight {

// A job that has not ended, as the scheduler sees it. Guarded by the scheduler's mutex, but for what is said otherwise.
struct JobRun {
  enum class Stage : std::uint8_t {
    kFollowing,  // Another run does its work: see `leader`.
    kWaiting,    // For a place; in `waiting_`, unless it is paused.
    kPreparing,  // Its index is made, or it waits for that.
    kReady,      // For a slice; in `ready_` or `urgent_`, unless it is paused.
    kSlicing,
    kEnded
  };

  // All that is needed to go on with a job of a process before.
  struct Restored {
    std::shared_ptr<const JobSpec> spec;
    std::shared_ptr<const Scene> scene;
    std::string checkpoint;  // As it was given to the store; empty: there is none.
  };
  using Restore = std::function<absl::StatusOr<Restored>()>;

  explicit JobRun(const Clock& clock) : stopwatch(clock) {}

  bool has_place() const { return stage == Stage::kPreparing || stage == Stage::kReady || stage == Stage::kSlicing; }
  // Where it stands in the queue for slices.
  FairQueue<std::shared_ptr<JobRun>>::Place Turn() const {
    return {spec->job_class, spec->owner, state.field == nullptr};
  }
  // Where it stands in the queues for a place and for its preparation.
  FairQueue<std::shared_ptr<JobRun>>::Place Entry() const { return {spec->job_class, spec->owner}; }

  std::shared_ptr<const JobSpec> spec;  // Never changes, but that a restored job gets its scene's outline.
  std::shared_ptr<const Scene> scene;   // Until it is prepared.
  Restore restore;                      // Of a job of a process before; until then.
  Cancellation cancellation;
  Stage stage = Stage::kWaiting;
  std::shared_ptr<JobRun> leader;                  // In stage kFollowing; else null.
  std::vector<std::shared_ptr<JobRun>> followers;  // Whose leader this is, in the order in which they came.
  bool pause_wanted = false;                       // Of a slice under way: by its end.
  JobState state;                                  // Published last. In stage kSlicing nobody but the runner writes it.
  std::unique_ptr<Rendering> rendering;            // In stage kSlicing the runner's alone.
  Stopwatch stopwatch;                             // Stands still while the job is paused.
  Clock::Time started;                             // On the stopwatch: accepted, then prepared.
  Clock::Time published;
  Clock::Time entered;                          // On the stopwatch: accepted or restored.
  std::optional<Clock::Time> cancel_requested;  // On the scheduler's clock.
  double rays_told = 0;                         // To the scheduler's events.
  // The runner's alone.
  Clock::Duration snapshot_cost{0};
  absl::Status failure;
  Clock::Time saved;  // When a checkpoint was made last, or tried.
  double own_checkpoint_seconds = 0;
  std::atomic<double> checkpoint_seconds = 0;  // Of processor time, on the store's thread.
  std::atomic<bool> saving = false;            // The last checkpoint is not written yet.
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SCHEDULER_JOB_RUN_H_
