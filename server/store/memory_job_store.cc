// SPDX-License-Identifier: Apache-2.0
#include "server/store/memory_job_store.h"

#include <utility>

#include "server/store/error.h"

namespace flatlight {
namespace {

// The probes' points and a field with every array; of a pixel, value and error.
double EstimateFieldBytes(const SceneTraits& traits, int channels) {
  return static_cast<double>(traits.probe_points) * (100.0 + 8 * (6 * channels + 1)) +
         static_cast<double>(traits.pixels) * 16 * channels;
}

// Of a job that has ended, a little more than what it holds.
double EstimateEndedBytes(const JobSpec& spec) {
  return 4096 + static_cast<double>(spec.scene->name.size()) +
         EstimateFieldBytes(spec.scene->traits, spec.scene->channels);
}

// Until then: scene and acceleration structure besides, points and pixels with what is gathered there, and a second
// field.
double EstimateBytes(const JobSpec& spec) {
  const SceneTraits& traits = spec.scene->traits;
  constexpr double kPixelBytes = 64;  // A float for each replicate.
  return EstimateEndedBytes(spec) + 400.0 * static_cast<double>(traits.elements) +
         EstimateFieldBytes(traits, spec.scene->channels) +
         static_cast<double>(traits.pixels) * kPixelBytes * spec.scene->channels;
}

}  // namespace

absl::StatusOr<std::optional<JobId>> MemoryJobStore::FindRequest(const RequestKey& key) {
  const std::lock_guard lock(mutex_);
  return FindRequestLocked(key);
}

absl::StatusOr<std::optional<JobId>> MemoryJobStore::FindRequestLocked(const RequestKey& key) {
  const Clock::Time oldest = clock_.Now() - kRequestMemory;
  while (!request_ages_.empty() && request_ages_.front().first < oldest) {
    requests_.erase(request_ages_.front().second);
    request_ages_.pop_front();
  }
  const auto found = requests_.find({key.caller, key.method, key.request_id});
  if (found == requests_.end()) return std::optional<JobId>();
  if (found->second.fingerprint != key.fingerprint) {
    return RequestIdReused(key, found->second.job);
  }
  return std::optional<JobId>(found->second.job);
}

absl::StatusOr<JobRecord> MemoryJobStore::Insert(JobRecord job, const Submission& submission,
                                                 const std::optional<RequestKey>& key) {
  const std::lock_guard lock(mutex_);
  if (key) {
    const auto earlier = FindRequestLocked(*key);
    if (!earlier.ok()) return earlier.status();
    if (*earlier) {
      const auto number = numbers_.find(**earlier);
      if (number == numbers_.end()) return NoSuchJob(**earlier);
      return jobs_.at(number->second).job;
    }
  }
  if (const auto number = numbers_.find(job.spec->id); number != numbers_.end()) return jobs_.at(number->second).job;
  const double bytes = HasEnded(job.state->phase) ? EstimateEndedBytes(*job.spec) : EstimateBytes(*job.spec);
  if (absl::Status room = MakeRoom(bytes); !room.ok()) return room;
  if (webhooks_ && !submission.webhook.empty()) {
    absl::Status noted = webhooks_->outbox.Insert(job.spec->id, job.spec->owner, submission.webhook);
    if (!noted.ok()) return noted;
  }
  bytes_ += bytes;
  const std::uint64_t number = next_number_++;
  numbers_[job.spec->id] = number;
  Entry& entry = jobs_[number];
  entry.job = job;
  entry.bytes = bytes;
  if (HasEnded(job.state->phase)) NoteEnd(number, entry);
  if (key) {
    const Name name{key->caller, key->method, key->request_id};
    requests_[name] = {key->fingerprint, job.spec->id};
    request_ages_.emplace_back(clock_.Now(), name);
    if (requests_.size() > limits_.max_requests) {
      requests_.erase(request_ages_.front().second);
      request_ages_.pop_front();
    }
  }
  return job;
}

absl::Status MemoryJobStore::MakeRoom(double bytes) {
  using std::chrono::milliseconds;
  if (bytes > limits_.max_bytes) {
    return MakeError(absl::StatusCode::kInvalidArgument, "JOB_TOO_BIG",
                     "the job needs about " + std::to_string(static_cast<long long>(bytes)) +
                         " bytes; allowed: " + std::to_string(static_cast<long long>(limits_.max_bytes)));
  }
  while (jobs_.size() >= limits_.max_jobs || bytes_ + bytes > limits_.max_bytes) {
    if (ended_.empty()) {
      if (jobs_.size() >= limits_.max_jobs) {
        return MakeQuotaError("TOO_MANY_JOBS", "max_jobs",
                              "the server holds " + std::to_string(jobs_.size()) +
                                  " jobs, none of which has ended; allowed: " + std::to_string(limits_.max_jobs),
                              milliseconds(1000));
      }
      return MakeQuotaError("JOBS_TOO_BIG", "max_job_bytes",
                            "the job needs about " + std::to_string(static_cast<long long>(bytes)) +
                                " bytes, and jobs that have not ended hold " +
                                std::to_string(static_cast<long long>(bytes_)) +
                                "; allowed in all: " + std::to_string(static_cast<long long>(limits_.max_bytes)),
                            milliseconds(1000));
    }
    Erase(ended_.begin()->second);
  }
  return absl::OkStatus();
}

void MemoryJobStore::NoteEnd(std::uint64_t number, Entry& entry) {
  bytes_ -= entry.bytes;
  entry.bytes = EstimateEndedBytes(*entry.job.spec);
  bytes_ += entry.bytes;
  ended_bytes_ += entry.bytes;
  entry.end = next_end_++;
  ended_[entry.end] = number;
  // The newest stays in any case: somebody has just waited for it.
  while (ended_bytes_ > limits_.max_ended_bytes && ended_.size() > 1) Erase(ended_.begin()->second);
}

void MemoryJobStore::Erase(std::uint64_t number) {
  const auto job = jobs_.find(number);
  const Entry& entry = job->second;
  bytes_ -= entry.bytes;
  if (entry.end != 0) {
    ended_bytes_ -= entry.bytes;
    ended_.erase(entry.end);
  }
  if (webhooks_ && !entry.job.spec->webhook.empty()) webhooks_->outbox.Detach(entry.job.spec->id).IgnoreError();
  numbers_.erase(entry.job.spec->id);
  jobs_.erase(job);
}

absl::Status MemoryJobStore::Update(const JobRecord& job) {
  JobRecord before;  // Released without the lock: that may free a large field.
  const std::lock_guard lock(mutex_);
  const auto number = numbers_.find(job.spec->id);
  if (number == numbers_.end()) return NoSuchJob(job.spec->id);
  Entry& entry = jobs_.at(number->second);
  before = std::exchange(entry.job, job);
  if (entry.end == 0 && before.spec != job.spec) {
    bytes_ -= entry.bytes;
    entry.bytes = EstimateBytes(*job.spec);
    bytes_ += entry.bytes;
  }
  if (entry.end == 0 && HasEnded(entry.job.state->phase)) {
    NoteEnd(number->second, entry);
    if (webhooks_ && !job.spec->webhook.empty()) {
      webhooks_->outbox.MakeDue(job.spec->id, webhooks_->format.WriteEvent(job)).IgnoreError();
      webhooks_->due();
    }
  }
  return absl::OkStatus();
}

absl::StatusOr<JobRecord> MemoryJobStore::Get(const JobId& id) {
  const std::lock_guard lock(mutex_);
  const auto number = numbers_.find(id);
  if (number == numbers_.end()) return NoSuchJob(id);
  return jobs_.at(number->second).job;
}

absl::StatusOr<JobPage> MemoryJobStore::List(const std::optional<std::string>& owner,
                                             std::optional<std::uint64_t> before, std::size_t limit) {
  const std::lock_guard lock(mutex_);
  return ListIf(before, limit, [&](const Entry& entry) { return !owner || entry.job.spec->owner == *owner; });
}

absl::StatusOr<JobPage> MemoryJobStore::ListShared(const std::vector<Grantee>& who, const std::string& owner,
                                                   std::optional<std::uint64_t> before, std::size_t limit) {
  const std::lock_guard lock(mutex_);
  return ListIf(before, limit, [&](const Entry& entry) {
    return entry.job.spec->owner != owner && AccessOf(entry.grants, who).has_value();
  });
}

JobPage MemoryJobStore::ListIf(std::optional<std::uint64_t> before, std::size_t limit,
                               const std::function<bool(const Entry&)>& wanted) {
  JobPage page;
  auto job = before ? jobs_.lower_bound(*before) : jobs_.end();
  while (job != jobs_.begin()) {
    --job;
    if (!wanted(job->second)) continue;
    if (page.jobs.size() == limit) {
      page.next_before = page.positions.back();
      break;
    }
    page.jobs.push_back(job->second.job);
    page.positions.push_back(job->first);
  }
  return page;
}

MemoryJobStore::Entry* MemoryJobStore::Find(const JobId& id) {
  const auto number = numbers_.find(id);
  return number == numbers_.end() ? nullptr : &jobs_.at(number->second);
}

absl::Status MemoryJobStore::Share(const JobId& id, const Grant& grant) {
  const std::lock_guard lock(mutex_);
  Entry* entry = Find(id);
  return entry == nullptr ? NoSuchJob(id) : AddGrant(id.Name(), grant, entry->grants);
}

absl::Status MemoryJobStore::Unshare(const JobId& id, const Grantee& grantee) {
  const std::lock_guard lock(mutex_);
  Entry* entry = Find(id);
  return entry == nullptr ? NoSuchJob(id) : RemoveGrant(id.Name(), grantee, entry->grants);
}

absl::StatusOr<std::vector<Grant>> MemoryJobStore::GrantsOf(const JobId& id) {
  const std::lock_guard lock(mutex_);
  const Entry* entry = Find(id);
  return entry == nullptr ? std::vector<Grant>() : entry->grants;
}

absl::Status MemoryJobStore::Delete(const JobId& id) {
  const std::lock_guard lock(mutex_);
  const auto number = numbers_.find(id);
  if (number == numbers_.end()) return NoSuchJob(id);
  Erase(number->second);
  return absl::OkStatus();
}

absl::StatusOr<std::vector<JobId>> MemoryJobStore::EndedBefore(JobClass job_class, WallTime before, std::size_t skip,
                                                               std::size_t limit) {
  const std::lock_guard lock(mutex_);
  std::vector<JobId> ids;
  for (const auto& [end, number] : ended_) {
    const JobRecord& job = jobs_.at(number).job;
    if (job.spec->job_class != job_class || !job.state->end_time || *job.state->end_time >= before) continue;
    if (skip > 0) {
      --skip;
      continue;
    }
    if (ids.size() == limit) break;
    ids.push_back(job.spec->id);
  }
  return ids;
}

}  // namespace flatlight
