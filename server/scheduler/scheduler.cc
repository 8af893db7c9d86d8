// SPDX-License-Identifier: Apache-2.0
#include "server/scheduler/scheduler.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <tuple>
#include <utility>

#include "server/store/error.h"

namespace flatlight {
namespace {

double Seconds(Clock::Duration duration) { return std::chrono::duration<double>(duration).count(); }

}  // namespace

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
                                            const Submission& submission, const std::optional<RequestKey>& key,
                                            const Quotas& quotas) {
  auto run = std::make_shared<JobRun>(clock_);
  run->spec = std::move(spec);
  run->scene = std::move(scene);
  const auto draining = MakeDrainingError();
  {
    const std::lock_guard lock(mutex_);
    if (stopping_) return draining;
    if (absl::Status allowed = CheckQuota(run->spec->owner, quotas); !allowed.ok()) return allowed;
    Owner& owner = owners_[run->spec->owner];
    ++owner.jobs;
    owner.quotas = quotas;
  }
  const std::shared_ptr<const JobState> done = StateOfDone(*run->spec);
  // Writing may take a while: without the lock.
  auto job = store_.Insert({run->spec, std::make_shared<JobState>(run->state)}, submission, key);
  bool too_late = false;
  {
    const std::lock_guard lock(mutex_);
    if (!job.ok() || job->spec->id != run->spec->id) {
      FreeQuota(run->spec->owner);
      return job;
    }
    too_late = stopping_;
    if (!too_late) Enter(run, done.get());
  }
  if (too_late) {
    // Told to come back only if it is not there when they do.
    if (absl::Status deleted = store_.Delete(run->spec->id); !deleted.ok()) return deleted;
    return draining;
  }
  TellListener();
  return done == nullptr ? job : store_.Get(job->spec->id);
}

void Scheduler::Resubmit(const JobRecord& job, JobRun::Restore restore, const Quotas& quotas) {
  auto run = std::make_shared<JobRun>(clock_);
  run->spec = job.spec;
  run->state = *job.state;
  run->restore = std::move(restore);
  {
    const std::lock_guard lock(mutex_);
    Owner& owner = owners_[run->spec->owner];
    ++owner.jobs;
    owner.quotas = quotas;
    if (options_.ledger != nullptr) CheckDay(run->spec->owner, options_.ledger->UsedToday(run->spec->owner));
    Enter(run, nullptr);
  }
  TellListener();
}

void Scheduler::Enter(const RunPtr& run, const JobState* done) {
  untold_.push_back(run->spec->id);
  run->entered = run->started = run->stopwatch.Now();
  runs_[run->spec->id] = run;
  if (run->state.phase == JobPhase::kPaused) {  // In a process before: it takes no place until it is resumed.
    run->stopwatch.Stop();
    return;
  }
  accounts_.Enter(run->spec->owner);
  if (done == nullptr) return FollowOrWait(run);
  Adopt(*done, *run);
  End(*run, JobPhase::kSucceeded);
}

void Scheduler::Admit() {
  const Clock::Time now = clock_.Now();
  while (accounts_.places() < options_.max_running_jobs) {
    const std::size_t free = options_.max_running_jobs - accounts_.places();
    const auto run =
        waiting_.Pop([&](const std::string& user, JobClass job_class) -> std::optional<Accounts::PlaceRank> {
          const Accounts::PlaceRank rank = accounts_.PlaceRankOf(user, job_class);
          if (rank.first >= free || IsSpent(user)) return std::nullopt;
          return rank;
        });
    if (!run) break;
    pace_.NoteAdmission(now);
    (*run)->stage = JobRun::Stage::kPreparing;
    (*run)->state.queue.reset();
    accounts_.TakePlace((*run)->spec->owner, (*run)->spec->job_class);
    if (options_.events != nullptr) {
      options_.events->Admitted(*(*run)->spec, (*run)->stopwatch.Now() - (*run)->entered);
    }
    preparing_.Push((*run)->Entry(), *run);
    starters_->Post(0, [this] { PrepareNext(); });
  }
  if (waiting_.empty()) {
    pace_.NoteNobodyWaits();
  } else {
    pace_.NoteWaiting(now);
    if (!places_told_ || now - *places_told_ >= options_.queue_interval) TellPlaces();
  }
}

void Scheduler::TellPlaces() {
  places_told_ = clock_.Now();
  const auto now = std::chrono::system_clock::now();
  const std::size_t free = options_.max_running_jobs - accounts_.places();
  std::size_t ahead = 0;
  const auto rank = [&](const std::string& user, JobClass job_class) { return accounts_.PlaceRankOf(user, job_class); };
  for (const RunPtr& run : waiting_.InTurn(rank)) {
    if (IsSpent(run->spec->owner)) {
      EnterRest(*run);
      continue;
    }
    QueuePlace place;
    place.reason = free > 0 ? QueuePlace::Reason::kOwnJobs : QueuePlace::Reason::kServerFull;
    place.ahead = ahead++;
    if (const auto wait = pace_.Wait(place.ahead)) {
      place.expected_start = std::chrono::time_point_cast<WallTime::duration>(now + *wait);
    }
    if (run->state.queue == place) continue;
    run->state.queue = place;
    Publish(*run);
  }
}

void Scheduler::Publish(JobRun& run) {
  run.published = clock_.Now();
  if (run.state.start_time) run.state.elapsed_seconds = Seconds(run.stopwatch.Now() - run.started);
  // Watchers hear of a restored job when its probes are known.
  if (run.restore == nullptr || HasEnded(run.state.phase)) ++run.state.sequence;
  Store(run);
  if (HasEnded(run.state.phase)) return;  // Its end is not theirs: a store that outlives the process would write it.
  for (const RunPtr& follower : run.followers) {
    Adopt(run.state, *follower);
    Store(*follower);
  }
}

void Scheduler::Store(const JobRun& run) {
  // The job may have been deleted; then nobody wants to know.
  store_.Update({run.spec, std::make_shared<JobState>(run.state)}).IgnoreError();
  untold_.push_back(run.spec->id);
}

void Scheduler::TellListener() {
  std::vector<JobId> changed;
  {
    const std::lock_guard lock(mutex_);
    changed.swap(untold_);
  }
  for (const JobId& id : changed) listener_(id);
}

void Scheduler::End(JobRun& run, JobPhase phase) {
  if (run.has_place()) accounts_.GivePlace(run.spec->owner, run.spec->job_class);
  if (run.state.phase != JobPhase::kPaused) accounts_.Leave(run.spec->owner);
  run.stage = JobRun::Stage::kEnded;
  shared_work_.Forget(run);
  if (phase == JobPhase::kSucceeded) shared_work_.NoteDone(run);
  // A large scene takes a while to free: not under the lock.
  if (run.scene != nullptr) starters_->Post(0, [scene = std::move(run.scene)] {});
  run.state.phase = phase;
  run.state.queue.reset();
  run.state.end_time = std::chrono::system_clock::now();
  run.state.expire_time = options_.retention.ExpireTime(run.spec->job_class, *run.state.end_time);
  std::vector<RunPtr> followers;  // They end too, below.
  if (phase == JobPhase::kSucceeded) followers.swap(run.followers);
  Publish(run);
  if (options_.events != nullptr) {
    if (run.cancel_requested) options_.events->Cancelled(*run.spec, clock_.Now() - *run.cancel_requested);
    options_.events->Ended(*run.spec, run.state);
  }
  runs_.erase(run.spec->id);
  FreeQuota(run.spec->owner);
  for (const RunPtr& follower : followers) {
    follower->leader.reset();
    Adopt(run.state, *follower);
    End(*follower, JobPhase::kSucceeded);
  }
  SendAway(run);
  Admit();
  run_stopped_.notify_all();
  if (stopping_ && runs_.empty()) ready_changed_.notify_all();
}

Scheduler::RunPtr Scheduler::Find(const JobId& id) {
  const auto found = runs_.find(id);
  return found == runs_.end() ? nullptr : found->second;
}

void Scheduler::RequestCancel(const RunPtr& run) {
  if (run->cancellation.cancelled()) return;
  run->cancellation.Cancel();
  run->cancel_requested = clock_.Now();
  if (run->stage == JobRun::Stage::kFollowing) Unfollow(*run);
  if (run->stage == JobRun::Stage::kWaiting || run->stage == JobRun::Stage::kPreparing) {
    waiting_.Remove(run->Entry(), run);
    preparing_.Remove(run->Entry(), run);
    End(*run, JobPhase::kCancelled);
  } else if (run->stage == JobRun::Stage::kReady) {
    ready_.Remove(run->Turn(), run);
    urgent_.push_back(run);
    ready_changed_.notify_one();
  }
}

void Scheduler::RequestCancel(const JobId& id) {
  {
    const std::lock_guard lock(mutex_);
    if (const RunPtr run = Find(id)) RequestCancel(run);
  }
  TellListener();
}

absl::StatusOr<JobRecord> Scheduler::Cancel(const JobId& id) {
  {
    std::unique_lock lock(mutex_);
    if (const RunPtr run = Find(id)) {
      RequestCancel(run);
      run_stopped_.wait(lock, [&] { return run->stage == JobRun::Stage::kEnded; });
    }
  }
  TellListener();
  return store_.AwaitEnd(id);
}

void Scheduler::EnterPause(JobRun& run) {
  run.pause_wanted = false;
  run.stopwatch.Stop();
  run.state.phase = JobPhase::kPaused;
  run.state.queue.reset();
  accounts_.Leave(run.spec->owner);
  SendAway(run);
  Publish(run);
  run_stopped_.notify_all();
}

absl::StatusOr<JobRecord> Scheduler::Pause(const JobId& id) {
  {
    std::unique_lock lock(mutex_);
    const RunPtr run = Find(id);
    if (run != nullptr && run->state.phase != JobPhase::kPaused && !run->cancellation.cancelled()) {
      switch (run->stage) {
        case JobRun::Stage::kFollowing:
          Unfollow(*run);
          [[fallthrough]];
        case JobRun::Stage::kWaiting:
          waiting_.Remove(run->Entry(), run);
          EnterPause(*run);
          Admit();
          break;
        case JobRun::Stage::kPreparing:
          EnterPause(*run);
          break;
        case JobRun::Stage::kReady:
          ready_.Remove(run->Turn(), run);
          EnterPause(*run);
          break;
        case JobRun::Stage::kSlicing:
          run->pause_wanted = true;
          run_stopped_.wait(lock, [&] { return !run->pause_wanted; });
          break;
        case JobRun::Stage::kEnded:
          break;
      }
    }
  }
  TellListener();
  if (absl::Status saved = store_.SavePause(id); !saved.ok()) return saved;
  auto job = store_.Get(id);
  if (job.ok() && HasEnded(job->state->phase)) {
    return MakeError(absl::StatusCode::kFailedPrecondition, "JOB_ENDED", id.Name() + " has ended: it cannot be paused");
  }
  return job;
}

absl::StatusOr<JobRecord> Scheduler::Resume(const JobId& id) {
  bool had_ended = false;
  {
    const std::lock_guard lock(mutex_);
    const RunPtr run = Find(id);
    had_ended = run == nullptr;
    if (run != nullptr && run->state.phase == JobPhase::kPaused && !run->cancellation.cancelled()) {
      run->stopwatch.Continue();
      run->state.phase = run->state.start_time ? JobPhase::kRunning : JobPhase::kQueued;
      accounts_.Enter(run->spec->owner);
      Publish(*run);
      if (run->stage == JobRun::Stage::kWaiting) {
        FollowOrWait(run);
      } else if (run->stage == JobRun::Stage::kReady) {
        Requeue(run);
      }
    }
  }
  TellListener();
  if (absl::Status saved = store_.SavePause(id); !saved.ok()) return saved;
  auto job = store_.Get(id);
  if (job.ok() && had_ended) {
    return MakeError(absl::StatusCode::kFailedPrecondition, "JOB_ENDED", id.Name() + " has ended: it cannot go on");
  }
  return job;
}

absl::Status Scheduler::Delete(const JobId& id) {
  // Writing may take a while: without the lock.
  if (absl::Status deleted = store_.Delete(id); !deleted.ok()) return deleted;
  {
    const std::lock_guard lock(mutex_);
    untold_.push_back(id);
    if (const RunPtr run = Find(id)) RequestCancel(run);
  }
  TellListener();
  return absl::OkStatus();
}

SchedulerLoad Scheduler::Load() {
  SchedulerLoad load;
  const std::lock_guard lock(mutex_);
  for (const auto& [id, run] : runs_) {
    SchedulerLoad::User& user = load.users[run->spec->owner];
    ++(run->state.phase == JobPhase::kPaused   ? user.paused
       : run->stage == JobRun::Stage::kWaiting ? user.waiting
                                               : user.running);
    user.cpu_seconds += run->state.cpu_seconds;
  }
  return load;
}

std::vector<JobId> Scheduler::Unended(std::size_t most) {
  struct Place {
    int group = 0;
    WallTime created;
    JobId id;
  };
  std::vector<Place> places;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, run] : runs_) {
      const int group = run->state.phase == JobPhase::kPaused ? 2 : run->has_place() ? 0 : 1;
      places.push_back({group, run->spec->create_time, id});
    }
  }
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return std::tie(a.group, a.created, a.id.uuid()) < std::tie(b.group, b.created, b.id.uuid());
  });
  std::vector<JobId> ids;
  for (const Place& place : places) {
    if (ids.size() < most) ids.push_back(place.id);
  }
  return ids;
}

void Scheduler::Suspend(JobRun& run) {
  if (run.has_place()) accounts_.GivePlace(run.spec->owner, run.spec->job_class);
  if (run.state.phase != JobPhase::kPaused) accounts_.Leave(run.spec->owner);
  if (run.stage == JobRun::Stage::kFollowing) Unfollow(run);
  shared_work_.Forget(run);
  run.stage = JobRun::Stage::kEnded;
  run.pause_wanted = false;
  runs_.erase(run.spec->id);
  FreeQuota(run.spec->owner);
  run_stopped_.notify_all();
  if (runs_.empty()) ready_changed_.notify_all();
}

void Scheduler::Stop() {
  {
    const std::lock_guard lock(mutex_);
    if (!stopping_) {
      stopping_ = true;
      std::vector<RunPtr> runs;
      for (const auto& [id, run] : runs_) runs.push_back(run);
      // Those that follow and those that wait first, lest each that ends lets one of them in.
      std::ranges::sort(runs, {}, [](const RunPtr& run) { return run->stage; });
      for (const RunPtr& run : runs) {
        if (!store_.durable()) {
          RequestCancel(run);
        } else if (!run->has_place()) {
          waiting_.Remove(run->Entry(), run);
          Suspend(*run);
        } else if (run->stage == JobRun::Stage::kReady && !run->cancellation.cancelled()) {
          ready_.Remove(run->Turn(), run);
          urgent_.push_back(run);
        }
      }
    }
  }
  ready_changed_.notify_all();
  TellListener();
  for (std::thread& runner : runners_) runner.join();
  runners_.clear();
  starters_.reset();
}

}  // namespace flatlight
