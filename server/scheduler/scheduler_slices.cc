// SPDX-License-Identifier: Apache-2.0
// The scheduler's own threads: preparation and slices.
#include <algorithm>
#include <exception>
#include <new>
#include <utility>

#include "server/scheduler/field_check.h"
#include "server/scheduler/field_versions.h"
#include "server/scheduler/metered_executor.h"
#include "server/scheduler/scheduler.h"
#include "server/store/error.h"

namespace flatlight {
namespace {

// A snapshot may take at most this part of a job's time.
constexpr int kSnapshotShare = 10;
// Checkpoints may take this part of a job's processor time, and take about this long: the first one is not to be too
// large either.
constexpr double kCheckpointShare = 0.01;
constexpr double kCheckpointBytesPerSecond = 1e8;
// Of the last one, which waits in memory to be written.
constexpr std::size_t kMostLastCheckpointBytes = 256u << 20;

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

void Scheduler::PrepareNext() {
  RunPtr run;
  {
    const std::lock_guard lock(mutex_);
    const auto next =
        preparing_.Pop([&](const std::string& user, JobClass) { return std::optional(accounts_.RankOf(user)); });
    if (!next) return;
    run = *next;
    if (run->stage == JobRun::Stage::kEnded) return;
    if (LeavesJobs()) return Suspend(*run);
    accounts_.Serve(run->spec->owner);
  }
  const std::int64_t cpu_start = ThreadCpuNanoseconds();
  absl::StatusOr<JobRun::Restored> restored = JobRun::Restored{};
  std::optional<JobCheckpoint> checkpoint;
  if (run->restore != nullptr) {
    try {
      restored = run->restore();
    } catch (...) {
      restored = WhatFailed();
    }
    if (restored.ok()) checkpoint = ReadJobCheckpoint(restored->checkpoint);
    if (checkpoint && checkpoint->job_key != restored->spec->job_key) checkpoint.reset();
  }
  std::shared_ptr<const Scene> scene;
  {
    const std::lock_guard lock(mutex_);
    if (run->stage == JobRun::Stage::kEnded) return;
    scene = std::move(run->scene);
    if (restored.ok() && restored->spec != nullptr) {
      run->spec = restored->spec;
      scene = restored->scene;
    }
    run->restore = nullptr;
    run->started = run->stopwatch.Now();
    run->saved = clock_.Now();
    run->state.start_time = std::chrono::system_clock::now();
    if (checkpoint) {
      run->started -=
          std::chrono::duration_cast<Clock::Duration>(std::chrono::duration<double>(checkpoint->elapsed_seconds));
      run->state.cpu_seconds = checkpoint->cpu_seconds;
      const std::chrono::nanoseconds since_epoch(checkpoint->start_time);
      run->state.start_time = WallTime(std::chrono::duration_cast<WallTime::duration>(since_epoch));
    }
    if (run->state.phase != JobPhase::kPaused) run->state.phase = JobPhase::kRunning;
    Publish(*run);
  }
  TellListener();
  std::unique_ptr<Rendering> rendering;
  absl::Status failure = restored.status();
  try {
    if (failure.ok()) rendering = StartOrResume(*run->spec, scene, checkpoint);
  } catch (...) {
    failure = WhatFailed();
  }
  restored = JobRun::Restored{};
  scene.reset();
  const double cpu_seconds = static_cast<double>(ThreadCpuNanoseconds() - cpu_start) * 1e-9;
  {
    const std::lock_guard lock(mutex_);
    Charge(run->spec->owner, cpu_seconds);
    if (run->stage == JobRun::Stage::kEnded) return;
    if (LeavesJobs()) return Suspend(*run);
    run->state.cpu_seconds += cpu_seconds;
    if (options_.events != nullptr) options_.events->Worked(*run->spec, 0, cpu_seconds);
    if (rendering != nullptr) run->rays_told = rendering->Progress().rays;
    run->rendering = std::move(rendering);
    if (!failure.ok()) {
      run->state.error = failure;
      End(*run, JobPhase::kFailed);
    } else {
      Requeue(run);
    }
  }
  TellListener();
}

std::unique_ptr<Rendering> Scheduler::StartOrResume(const JobSpec& spec, const std::shared_ptr<const Scene>& scene,
                                                    const std::optional<JobCheckpoint>& checkpoint) const {
  if (checkpoint) {
    auto rendering = start_(scene, spec);
    if (rendering->Resume(checkpoint->rendering)) return rendering;
  }
  return start_(scene, spec);
}

void Scheduler::MaybeCheckpoint(const RunPtr& run, double cpu_seconds) {
  if (!store_.durable() || run->saving || clock_.Now() - run->saved < options_.checkpoint_interval) return;
  run->saved = clock_.Now();
  const double allowed = kCheckpointShare * cpu_seconds - run->own_checkpoint_seconds - run->checkpoint_seconds;
  if (allowed > 0) SaveCheckpoint(run, static_cast<std::size_t>(allowed * kCheckpointBytesPerSecond));
}

void Scheduler::SaveCheckpoint(const RunPtr& run, std::size_t most_bytes) {
  const std::int64_t cpu_start = ThreadCpuNanoseconds();
  try {
    JobCheckpoint checkpoint;
    checkpoint.rendering = run->rendering->Checkpoint(most_bytes);
    if (!checkpoint.rendering.empty()) {
      checkpoint.job_key = run->spec->job_key;
      checkpoint.elapsed_seconds = std::chrono::duration<double>(run->stopwatch.Now() - run->started).count();
      checkpoint.cpu_seconds = run->state.cpu_seconds;
      const auto since_epoch = run->state.start_time->time_since_epoch();
      checkpoint.start_time = std::chrono::duration_cast<std::chrono::nanoseconds>(since_epoch).count();
      run->saving = true;
      store_.SaveCheckpoint(run->spec->id, WriteJobCheckpoint(checkpoint), [run](double seconds) {
        run->checkpoint_seconds += seconds;
        run->saving = false;
      });
    }
  } catch (const std::bad_alloc&) {
    // The job goes on without one.
  }
  run->own_checkpoint_seconds += static_cast<double>(ThreadCpuNanoseconds() - cpu_start) * 1e-9;
}

void Scheduler::Requeue(const RunPtr& run) {
  run->stage = JobRun::Stage::kReady;
  if (run->cancellation.cancelled() || LeavesJobs()) {
    urgent_.push_back(run);
  } else if (run->state.phase != JobPhase::kPaused) {
    ready_.Push(run->Turn(), run);
    if (IsSpent(run->spec->owner)) EnterRest(*run);
  }
  ready_changed_.notify_one();
}

Scheduler::RunPtr Scheduler::NextReady() {
  if (!urgent_.empty()) {
    RunPtr run = std::move(urgent_.front());
    urgent_.pop_front();
    return run;
  }
  return ready_
      .Pop([&](const std::string& user, JobClass) {
        return IsSpent(user) ? std::nullopt : std::optional(accounts_.RankOf(user));
      })
      .value_or(nullptr);
}

void Scheduler::RunSlices() {
  std::unique_lock lock(mutex_);
  while (true) {
    if (MaybeBeginDay()) {
      lock.unlock();
      TellListener();
      lock.lock();
    }
    RunPtr run = NextReady();
    if (run == nullptr) {
      if (stopping_ && runs_.empty()) return;
      if (spent_.empty()) {
        ready_changed_.wait(lock);
      } else {
        ready_changed_.wait_for(lock, options_.day_interval);
      }
      continue;
    }
    run->stage = JobRun::Stage::kSlicing;
    accounts_.Serve(run->spec->owner);
    const bool leave = LeavesJobs() && !run->cancellation.cancelled();
    const double cpu_seconds = run->state.cpu_seconds;
    lock.unlock();
    if (leave) {
      SaveCheckpoint(run, kMostLastCheckpointBytes);
      lock.lock();
      Suspend(*run);
      continue;
    }
    MaybeCheckpoint(run, cpu_seconds);
    RunSlice(*run);
    lock.lock();
    if (run->stage == JobRun::Stage::kSlicing) {
      if (run->pause_wanted && !run->cancellation.cancelled()) EnterPause(*run);
      Requeue(run);
    }
    run->pause_wanted = false;
    run_stopped_.notify_all();
    lock.unlock();
    TellListener();
    run.reset();
    lock.lock();
  }
}

void Scheduler::RunSlice(JobRun& run) {
  MeteredExecutor executor(executor_);
  const bool first = run.state.field == nullptr;
  JobState next = run.state;
  bool publish = false;
  bool done = false;
  try {
    Rendering& rendering = *run.rendering;
    if (!run.cancellation.cancelled()) {
      rendering.Advance(executor, run.cancellation, run.stopwatch, first ? options_.first_slice : options_.slice);
    }
    done = rendering.done();
    next.progress = rendering.Progress();
    const bool has_picture =
        done || next.progress.fraction > 0 || next.progress.samples > 0 || next.progress.records > 0;
    const Clock::Time now = clock_.Now();
    const Clock::Duration interval = std::max(options_.publish_interval, kSnapshotShare * run.snapshot_cost);
    publish = done || run.cancellation.cancelled() || (first && has_picture) || now - run.published >= interval;
    if (publish && has_picture) {
      next.field = rendering.Snapshot();
      next.shared_work = false;
      run.failure = CheckFinite(*run.spec->scene, *next.field);
      next.versions = StampVersions(*run.spec->scene, run.state.field.get(), run.state.versions, *next.field,
                                    run.state.sequence + 1);
      run.snapshot_cost = clock_.Now() - now;
    }
    if (done) next.end_reason = rendering.end_reason();
  } catch (...) {
    run.failure = WhatFailed();
  }
  const double cpu_seconds = executor.CpuSeconds();
  next.cpu_seconds += cpu_seconds;

  std::unique_ptr<Rendering> finished;  // Destroyed without the lock.
  const std::lock_guard lock(mutex_);
  Charge(run.spec->owner, cpu_seconds);
  if (options_.events != nullptr) {
    options_.events->Worked(*run.spec, std::max(0.0, next.progress.rays - run.rays_told), cpu_seconds);
    run.rays_told = next.progress.rays;
    if (first && next.field != nullptr) {
      options_.events->FirstPicture(*run.spec, run.stopwatch.Now() - run.entered);
    }
  }
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
  }
  if (run.stage == JobRun::Stage::kEnded) finished = std::move(run.rendering);
}

}  // namespace flatlight
