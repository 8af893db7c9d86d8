// SPDX-License-Identifier: Apache-2.0
#include "server/scheduler/scheduler.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <new>
#include <utility>

#include "core/execution/cancellation.h"
#include "server/scheduler/field_check.h"
#include "server/scheduler/field_versions.h"
#include "server/scheduler/metered_executor.h"
#include "server/store/error.h"

namespace flatlight {
namespace {

// Newcomers come first, but not so that a stream of them stops all others.
constexpr int kMaxNewcomersInARow = 4;
// A snapshot may take at most this part of a job's time.
constexpr int kSnapshotShare = 10;

double Seconds(Clock::Duration duration) { return std::chrono::duration<double>(duration).count(); }

absl::Status WhatFailed() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return MakeError(absl::StatusCode::kResourceExhausted, "OUT_OF_MEMORY",
                     "the job needs more memory than the server has");
  } catch (const std::exception& failure) {
    return MakeError(absl::StatusCode::kInternal, "RENDERING_FAILED", failure.what());
  }
}

}  // namespace

struct Scheduler::Run {
  enum class Stage : std::uint8_t { kWaiting, kPreparing, kReady, kSlicing, kEnded };

  std::shared_ptr<const JobSpec> spec;
  std::shared_ptr<const Scene> scene;  // Until it is prepared.
  Cancellation cancellation;
  Stage stage = Stage::kWaiting;         // Guarded by the scheduler's mutex, as is `state`.
  JobState state;                        // Published last.
  std::unique_ptr<Rendering> rendering;  // In stage kSlicing the runner's alone.
  Clock::Time started;
  Clock::Time published;
  Clock::Duration snapshot_cost{0};
  absl::Status failure;
};

Scheduler::Scheduler(const SchedulerOptions& options, JobStore& store, Executor& executor, const Clock& clock,
                     Start start, Listener listener)
    : options_(options),
      store_(store),
      executor_(executor),
      clock_(clock),
      start_(std::move(start)),
      listener_(std::move(listener)),
      starters_(std::make_unique<TaskQueue>(options.starters, std::numeric_limits<std::size_t>::max())) {
  for (int i = 0; i < options.runners; ++i) runners_.emplace_back([this] { RunSlices(); });
}

Scheduler::~Scheduler() { Stop(); }

absl::StatusOr<JobRecord> Scheduler::Submit(std::shared_ptr<const JobSpec> spec, std::shared_ptr<const Scene> scene,
                                            const std::optional<RequestKey>& key) {
  auto run = std::make_shared<Run>();
  run->spec = std::move(spec);
  run->scene = std::move(scene);
  absl::StatusOr<JobRecord> job;
  {
    const std::lock_guard lock(mutex_);
    if (stopping_) return MakeError(absl::StatusCode::kUnavailable, "DRAINING", "the server is going down");
    job = store_.Insert({run->spec, std::make_shared<JobState>(run->state)}, key);
    if (!job.ok() || job->spec->id != run->spec->id) return job;
    runs_[run->spec->id] = run;
    waiting_.push_back(run);
    Admit();
  }
  listener_(run->spec->id);
  return job;
}

void Scheduler::Admit() {
  while (running_ < options_.max_running_jobs && !waiting_.empty()) {
    RunPtr run = std::move(waiting_.front());
    waiting_.pop_front();
    if (run->stage == Run::Stage::kEnded) continue;
    run->stage = Run::Stage::kPreparing;
    ++running_;
    starters_->Post(0, [this, run] { Prepare(run); });
  }
}

void Scheduler::Prepare(const RunPtr& run) {
  std::shared_ptr<const Scene> scene;
  {
    const std::lock_guard lock(mutex_);
    if (run->stage == Run::Stage::kEnded) return;
    scene = std::move(run->scene);
    run->started = clock_.Now();
    run->state.start_time = std::chrono::system_clock::now();
    run->state.phase = JobPhase::kRunning;
    Publish(*run);
  }
  listener_(run->spec->id);
  const std::int64_t cpu_start = ThreadCpuNanoseconds();
  std::unique_ptr<Rendering> rendering;
  absl::Status failure;
  try {
    rendering = start_(std::move(scene), run->spec->plan);
  } catch (...) {
    failure = WhatFailed();
  }
  const double cpu_seconds = static_cast<double>(ThreadCpuNanoseconds() - cpu_start) * 1e-9;
  {
    const std::lock_guard lock(mutex_);
    if (run->stage == Run::Stage::kEnded) return;
    run->state.cpu_seconds += cpu_seconds;
    run->rendering = std::move(rendering);
    if (!failure.ok()) {
      run->state.error = failure;
      End(*run, JobPhase::kFailed);
    } else {
      run->stage = Run::Stage::kReady;
      newcomers_.push_back(run);
    }
  }
  ready_changed_.notify_one();
  if (!failure.ok()) listener_(run->spec->id);
}

Scheduler::RunPtr Scheduler::NextReady() {
  std::deque<RunPtr>* queue = nullptr;
  if (!urgent_.empty()) {
    queue = &urgent_;
  } else if (!newcomers_.empty() && (ready_.empty() || newcomers_in_a_row_ < kMaxNewcomersInARow)) {
    queue = &newcomers_;
    ++newcomers_in_a_row_;
  } else if (!ready_.empty()) {
    queue = &ready_;
    newcomers_in_a_row_ = 0;
  } else {
    return nullptr;
  }
  RunPtr run = std::move(queue->front());
  queue->pop_front();
  return run;
}

void Scheduler::RunSlices() {
  std::unique_lock lock(mutex_);
  while (true) {
    RunPtr run = NextReady();
    if (run == nullptr) {
      if (stopping_ && runs_.empty()) return;
      ready_changed_.wait(lock);
      continue;
    }
    // A cancelled run is in two queues, and found first in `urgent_`.
    if (run->stage != Run::Stage::kReady) continue;
    run->stage = Run::Stage::kSlicing;
    lock.unlock();
    if (RunSlice(*run)) listener_(run->spec->id);
    lock.lock();
    if (run->stage == Run::Stage::kSlicing) {
      run->stage = Run::Stage::kReady;
      const bool cancelled = run->cancellation.cancelled();
      (cancelled ? urgent_ : run->state.field == nullptr ? newcomers_ : ready_).push_back(run);
    }
  }
}

bool Scheduler::RunSlice(Run& run) {
  MeteredExecutor executor(executor_);
  const bool first = run.state.field == nullptr;
  JobState next = run.state;
  bool publish = false;
  bool done = false;
  try {
    Rendering& rendering = *run.rendering;
    if (!run.cancellation.cancelled()) {
      rendering.Advance(executor, run.cancellation, clock_, first ? options_.first_slice : options_.slice);
    }
    done = rendering.done();
    next.progress = rendering.Progress();
    const bool has_picture = done || next.progress.fraction > 0 || next.progress.samples > 0;
    const Clock::Time now = clock_.Now();
    const Clock::Duration interval = std::max(options_.publish_interval, kSnapshotShare * run.snapshot_cost);
    publish = done || run.cancellation.cancelled() || (first && has_picture) || now - run.published >= interval;
    if (publish && has_picture) {
      next.field = rendering.Snapshot();
      run.failure = CheckFinite(*run.spec->scene, *next.field);
      next.versions = StampVersions(*run.spec->scene, run.state.field.get(), run.state.versions, *next.field,
                                    run.state.sequence + 1);
      run.snapshot_cost = clock_.Now() - now;
    }
    if (done) next.end_reason = rendering.end_reason();
  } catch (...) {
    run.failure = WhatFailed();
  }
  next.cpu_seconds += executor.CpuSeconds();

  std::unique_ptr<Rendering> finished;  // Destroyed without the lock.
  const std::lock_guard lock(mutex_);
  if (!run.failure.ok()) {
    run.state.cpu_seconds = next.cpu_seconds;
    run.state.error = run.failure;
    End(run, JobPhase::kFailed);
  } else if (done || run.cancellation.cancelled()) {
    run.state = std::move(next);
    End(run, done ? JobPhase::kSucceeded : JobPhase::kCancelled);
  } else if (publish) {
    run.state = std::move(next);
    Publish(run);
  } else {
    run.state.cpu_seconds = next.cpu_seconds;
    return false;
  }
  if (run.stage == Run::Stage::kEnded) finished = std::move(run.rendering);
  return true;
}

void Scheduler::Publish(Run& run) {
  run.published = clock_.Now();
  if (run.state.start_time) run.state.elapsed_seconds = Seconds(run.published - run.started);
  ++run.state.sequence;
  // The job may have been deleted; then nobody wants to know.
  store_.Update(run.spec->id, std::make_shared<JobState>(run.state)).IgnoreError();
}

void Scheduler::End(Run& run, JobPhase phase) {
  if (run.stage == Run::Stage::kPreparing || run.stage == Run::Stage::kReady || run.stage == Run::Stage::kSlicing)
    --running_;
  run.stage = Run::Stage::kEnded;
  // A large scene takes a while to free: not under the lock.
  if (run.scene != nullptr) starters_->Post(0, [scene = std::move(run.scene)] {});
  run.state.phase = phase;
  run.state.end_time = std::chrono::system_clock::now();
  Publish(run);
  runs_.erase(run.spec->id);
  Admit();
  run_ended_.notify_all();
  if (stopping_ && runs_.empty()) ready_changed_.notify_all();
}

void Scheduler::RequestCancel(Run& run) {
  run.cancellation.Cancel();
  if (run.stage == Run::Stage::kWaiting || run.stage == Run::Stage::kPreparing) {
    End(run, JobPhase::kCancelled);
  } else if (run.stage == Run::Stage::kReady) {
    urgent_.push_back(runs_.at(run.spec->id));
    ready_changed_.notify_one();
  }
}

absl::StatusOr<JobRecord> Scheduler::Cancel(const JobId& id) {
  RunPtr run;
  {
    std::unique_lock lock(mutex_);
    if (const auto found = runs_.find(id); found != runs_.end()) {
      run = found->second;
      RequestCancel(*run);
      run_ended_.wait(lock, [&] { return run->stage == Run::Stage::kEnded; });
    }
  }
  if (run != nullptr) listener_(id);
  return store_.Get(id);
}

absl::Status Scheduler::Delete(const JobId& id) {
  {
    const std::lock_guard lock(mutex_);
    if (absl::Status deleted = store_.Delete(id); !deleted.ok()) return deleted;
    if (const auto found = runs_.find(id); found != runs_.end()) {
      const RunPtr run = found->second;
      RequestCancel(*run);
    }
  }
  listener_(id);
  return absl::OkStatus();
}

void Scheduler::Stop() {
  std::vector<RunPtr> runs;
  {
    const std::lock_guard lock(mutex_);
    if (!stopping_) {
      stopping_ = true;
      waiting_.clear();
      for (const auto& [id, run] : runs_) runs.push_back(run);
      for (const RunPtr& run : runs) RequestCancel(*run);
    }
  }
  ready_changed_.notify_all();
  for (const RunPtr& run : runs) listener_(run->spec->id);
  for (std::thread& runner : runners_) runner.join();
  runners_.clear();
  starters_.reset();
}

}  // namespace flatlight
