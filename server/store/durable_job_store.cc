// SPDX-License-Identifier: Apache-2.0
#include "server/store/durable_job_store.h"

#include <ctime>
#include <utility>

namespace flatlight {
namespace {

constexpr std::size_t kMostClassifiedAtOnce = 1000;

WallTime Now() { return std::chrono::system_clock::now(); }

double ThreadCpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

DurableJobStore::DurableJobStore(const Options& options, const Clock& clock, JobArchive& archive,
                                 const JobFormat& format, std::function<void(const JobId&)> ended,
                                 std::function<void(const absl::Status&)> health)
    : options_(options),
      memory_(options.memory, clock),
      archive_(archive),
      format_(format),
      ended_(std::move(ended)),
      tell_health_(std::move(health)),
      writer_([this] { Work(); }) {}

DurableJobStore::~DurableJobStore() { Close(); }

void DurableJobStore::Close() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  if (writer_.joinable()) writer_.join();
}

absl::StatusOr<std::vector<JobRecord>> DurableJobStore::Restore() {
  const auto unfinished = archive_.Unfinished();
  if (!unfinished.ok()) return unfinished.status();
  std::vector<JobRecord> jobs;
  for (const ArchivedJob& job : *unfinished) {
    auto record = format_.Read(job, nullptr);
    if (!record.ok()) return record.status();
    if (job.paused) {
      auto state = std::make_shared<JobState>(*record->state);
      state->phase = JobPhase::kPaused;
      record->state = std::move(state);
    }
    if (const auto inserted = memory_.Insert(*record, {}, std::nullopt); !inserted.ok()) return inserted.status();
    jobs.push_back(*std::move(record));
  }
  return jobs;
}

absl::StatusOr<std::optional<JobId>> DurableJobStore::FindRequest(const RequestKey& key) {
  return archive_.FindRequest(key, Now());
}

absl::StatusOr<JobRecord> DurableJobStore::Insert(JobRecord job, const Submission& submission,
                                                  const std::optional<RequestKey>& key) {
  const JobId id = job.spec->id;
  // In memory first: nobody may find it in the archive and not there.
  auto inserted = memory_.Insert(job, submission, std::nullopt);
  if (!inserted.ok()) return inserted;
  const auto made = archive_.Insert(id, job.spec->owner, format_.WriteMessage(job), submission, key, Now());
  if (!absl::IsAlreadyExists(made.status())) NoteHealth(made.status());
  if (made.ok() && *made == id) return inserted;
  memory_.Delete(id).IgnoreError();
  if (!made.ok()) return made.status();
  return Get(*made);
}

absl::Status DurableJobStore::Update(const JobRecord& job) {
  if (!HasEnded(job.state->phase)) return memory_.Update(job);
  {
    const std::lock_guard lock(mutex_);
    if (unwritten_.emplace(job.spec->id, End{job}).second) ends_.push_back(job.spec->id);
  }
  wake_.notify_one();
  return absl::OkStatus();
}

absl::Status DurableJobStore::SavePause(const JobId& id) {
  const std::lock_guard lock(pausing_);
  const auto job = memory_.Get(id);
  if (!job.ok() || HasEnded(job->state->phase)) return absl::OkStatus();
  absl::Status written = archive_.SavePause(id, job->state->phase == JobPhase::kPaused);
  NoteHealth(written);
  return written;
}

absl::StatusOr<JobRecord> DurableJobStore::Read(const JobId& id, bool whole) {
  const auto job = archive_.Get(id);
  if (!job.ok()) return job.status();
  if (!whole || !job->result) return format_.Read(*job, nullptr);
  const auto result = archive_.Fetch(*job->result);
  if (!result.ok()) return result.status();
  return format_.Read(*job, &*result);
}

absl::StatusOr<JobRecord> DurableJobStore::Find(const JobId& id, bool whole) {
  auto job = memory_.Get(id);
  if (job.ok()) return job;
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = unwritten_.find(id); found != unwritten_.end()) return found->second.job;
  }
  return Read(id, whole);
}

absl::StatusOr<JobRecord> DurableJobStore::Get(const JobId& id) { return Find(id, false); }

absl::StatusOr<JobRecord> DurableJobStore::GetWhole(const JobId& id) {
  auto job = Find(id, true);
  if (!job.ok() || !HasEnded(job->state->phase)) return job;
  // For those who ask next, as far as there is room; but not one that was deleted meanwhile.
  memory_.Insert(*job, {}, std::nullopt).IgnoreError();
  if (absl::IsNotFound(archive_.Get(id).status())) memory_.Delete(id).IgnoreError();
  return job;
}

absl::StatusOr<JobPage> DurableJobStore::List(const std::optional<std::string>& owner,
                                              std::optional<std::uint64_t> before, std::size_t limit) {
  return PageOf(archive_.List(owner, before, limit));
}

absl::StatusOr<JobPage> DurableJobStore::ListShared(const std::vector<Grantee>& who, const std::string& owner,
                                                    std::optional<std::uint64_t> before, std::size_t limit) {
  return PageOf(archive_.ListShared(who, owner, before, limit));
}

absl::StatusOr<JobPage> DurableJobStore::PageOf(absl::StatusOr<JobArchive::Page> archived) {
  if (!archived.ok()) return archived.status();
  JobPage page;
  page.positions = std::move(archived->positions);
  page.next_before = archived->next_before;
  for (const ArchivedJob& archived_job : archived->jobs) {
    auto job = memory_.Get(archived_job.id);
    if (!job.ok()) job = format_.Read(archived_job, nullptr);
    if (!job.ok()) return job.status();
    page.jobs.push_back(*std::move(job));
  }
  return page;
}

absl::Status DurableJobStore::Delete(const JobId& id) {
  if (absl::Status deleted = archive_.Delete(id); !deleted.ok()) return deleted;
  memory_.Delete(id).IgnoreError();
  return absl::OkStatus();
}

absl::StatusOr<std::vector<JobId>> DurableJobStore::EndedBefore(JobClass job_class, WallTime before, std::size_t skip,
                                                                std::size_t limit) {
  if (absl::Status classified = ClassifySome(); !classified.ok()) return classified;
  return archive_.EndedBefore(job_class, before, skip, limit);
}

absl::Status DurableJobStore::ClassifySome() {
  const auto jobs = archive_.WithoutClass(kMostClassifiedAtOnce);
  if (!jobs.ok()) return jobs.status();
  std::vector<std::pair<JobId, JobClass>> classes;
  for (const ArchivedJob& job : *jobs) {
    const auto record = format_.Read(job, nullptr);
    // What cannot be read is kept: it may be graded.
    classes.emplace_back(job.id, record.ok() ? record->spec->job_class : JobClass::kGraded);
  }
  return archive_.Classify(classes);
}

absl::Status DurableJobStore::Share(const JobId& id, const Grant& grant) {
  absl::Status written = archive_.Share(id, grant);
  if (!absl::IsNotFound(written) && !absl::IsResourceExhausted(written)) NoteHealth(written);
  return written;
}

absl::Status DurableJobStore::Unshare(const JobId& id, const Grantee& grantee) { return archive_.Unshare(id, grantee); }

absl::StatusOr<std::vector<Grant>> DurableJobStore::GrantsOf(const JobId& id) { return archive_.GrantsOf(id); }

absl::StatusOr<JobRecord> DurableJobStore::AwaitEnd(const JobId& id) {
  {
    std::unique_lock lock(mutex_);
    shown_.wait(lock, [&] {
      const auto found = unwritten_.find(id);
      return found == unwritten_.end() || found->second.shown;
    });
  }
  return Get(id);
}

absl::StatusOr<std::shared_ptr<const std::string>> DurableJobStore::WrittenResult(const JobId& id) {
  const auto job = archive_.Get(id);
  if (!job.ok()) return job.status();
  if (!job->result) return nullptr;
  auto result = archive_.Fetch(*job->result);
  if (!result.ok()) return result.status();
  return std::make_shared<const std::string>(*std::move(result));
}

void DurableJobStore::SaveCheckpoint(const JobId& id, std::string checkpoint, std::function<void(double)> saved) {
  {
    const std::lock_guard lock(mutex_);
    checkpoints_.push_back({id, std::move(checkpoint), std::move(saved)});
  }
  wake_.notify_one();
}

void DurableJobStore::NoteHealth(const absl::Status& written) {
  {
    const std::lock_guard lock(mutex_);
    if (written.ok() == healthy_) return;
    healthy_ = written.ok();
  }
  tell_health_(written);
}

void DurableJobStore::Work() {
  using SteadyTime = std::chrono::steady_clock::time_point;
  std::unique_lock lock(mutex_);
  SteadyTime retry;  // Ends before it are not tried again.
  while (true) {
    const SteadyTime now = std::chrono::steady_clock::now();
    if (!ends_.empty() && (now >= retry || !unwritten_.at(ends_.front()).shown || stopping_)) {
      const JobId id = ends_.front();
      ends_.pop_front();
      const bool last_try = stopping_;
      if (!WriteEnd(lock, id)) {
        if (!last_try) ends_.push_back(id);
        retry = now + options_.retry;
      }
    } else if (!checkpoints_.empty()) {
      WriteCheckpoint(lock);
    } else if (stopping_) {
      return;
    } else if (ends_.empty()) {
      wake_.wait(lock);
    } else {
      wake_.wait_until(lock, retry);
    }
  }
}

bool DurableJobStore::WriteEnd(std::unique_lock<std::mutex>& lock, const JobId& id) {
  const JobRecord job = unwritten_.at(id).job;
  const bool shown = unwritten_.at(id).shown;
  lock.unlock();
  const absl::Status written =
      archive_.End(id, {.message = format_.WriteMessage(job),
                        .sequence = job.state->sequence,
                        .result = format_.WriteResult(job),
                        .time = job.state->end_time.value_or(Now()),
                        .job_class = job.spec->job_class,
                        .event = job.spec->webhook.empty() ? "" : format_.WriteEvent(job),
                        .work_key = job.state->phase == JobPhase::kSucceeded ? job.spec->work_key : ""});
  const bool deleted = absl::IsNotFound(written);
  if (!shown && !deleted) memory_.Update(job).IgnoreError();
  lock.lock();
  if (written.ok() || deleted) {
    unwritten_.erase(id);
  } else {
    unwritten_.at(id).shown = true;
  }
  shown_.notify_all();
  lock.unlock();
  if (!deleted) NoteHealth(written);
  if (!shown) ended_(id);
  lock.lock();
  return written.ok() || deleted;
}

void DurableJobStore::WriteCheckpoint(std::unique_lock<std::mutex>& lock) {
  Checkpoint checkpoint = std::move(checkpoints_.front());
  checkpoints_.pop_front();
  const bool wanted = unwritten_.find(checkpoint.id) == unwritten_.end();
  lock.unlock();
  const double start = ThreadCpuSeconds();
  const absl::Status written =
      wanted ? archive_.SaveCheckpoint(checkpoint.id, std::move(checkpoint.bytes)) : absl::OkStatus();
  checkpoint.saved(ThreadCpuSeconds() - start);
  // One that ended meanwhile, or was deleted, needs none.
  if (wanted && !absl::IsNotFound(written)) NoteHealth(written);
  lock.lock();
}

}  // namespace flatlight
