// SPDX-License-Identifier: Apache-2.0
#include "server/store/memory_job_store.h"

#include <utility>

#include "server/store/error.h"

namespace flatlight {
namespace {

constexpr std::chrono::hours kRequestMemory{24};

// A little more than what a running job holds: scene, acceleration structure, and two fields with every array.
double EstimateBytes(const JobSpec& spec) {
  const SceneTraits& traits = spec.scene->traits();
  return 4096 + 400.0 * static_cast<double>(traits.elements) +
         static_cast<double>(traits.probe_points) * (200.0 + 2 * 8 * (6 * spec.scene->channels() + 1));
}

absl::Status NoSuchJob(const JobId& id) {
  return MakeError(absl::StatusCode::kNotFound, "JOB_NOT_FOUND", id.Name() + " does not exist or was deleted");
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
    return MakeError(absl::StatusCode::kAlreadyExists, "REQUEST_ID_REUSED",
                     "request_id " + key.request_id + " was used for " + found->second.job.Name() +
                         " with other contents; use a new one for a new job");
  }
  return std::optional<JobId>(found->second.job);
}

absl::StatusOr<JobRecord> MemoryJobStore::Insert(JobRecord job, const std::optional<RequestKey>& key) {
  const std::lock_guard lock(mutex_);
  if (key) {
    const auto earlier = FindRequestLocked(*key);
    if (!earlier.ok()) return earlier.status();
    if (*earlier) {
      const auto number = numbers_.find(**earlier);
      if (number == numbers_.end()) return NoSuchJob(**earlier);
      return jobs_.at(number->second);
    }
  }
  const double bytes = EstimateBytes(*job.spec);
  if (absl::Status room = MakeRoom(bytes); !room.ok()) return room;
  bytes_ += bytes;
  const std::uint64_t number = next_number_++;
  numbers_[job.spec->id] = number;
  jobs_[number] = job;
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
  auto job = jobs_.begin();
  while (jobs_.size() >= limits_.max_jobs || bytes_ + bytes > limits_.max_bytes) {
    while (job != jobs_.end() && !HasEnded(job->second.state->phase)) ++job;
    if (job == jobs_.end()) {
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
    Erase(job++);
  }
  return absl::OkStatus();
}

void MemoryJobStore::Erase(std::map<std::uint64_t, JobRecord>::iterator job) {
  bytes_ -= EstimateBytes(*job->second.spec);
  numbers_.erase(job->second.spec->id);
  jobs_.erase(job);
}

absl::Status MemoryJobStore::Update(const JobId& id, std::shared_ptr<const JobState> state) {
  const std::lock_guard lock(mutex_);
  const auto number = numbers_.find(id);
  if (number == numbers_.end()) return NoSuchJob(id);
  // The old state is released after the swap, which may free a large field.
  jobs_.at(number->second).state.swap(state);
  return absl::OkStatus();
}

absl::StatusOr<JobRecord> MemoryJobStore::Get(const JobId& id) {
  const std::lock_guard lock(mutex_);
  const auto number = numbers_.find(id);
  if (number == numbers_.end()) return NoSuchJob(id);
  return jobs_.at(number->second);
}

JobPage MemoryJobStore::List(std::optional<std::uint64_t> before, std::size_t limit) {
  const std::lock_guard lock(mutex_);
  JobPage page;
  auto job = before ? jobs_.lower_bound(*before) : jobs_.end();
  while (job != jobs_.begin() && page.jobs.size() < limit) {
    --job;
    page.jobs.push_back(job->second);
  }
  if (job != jobs_.begin()) page.next_before = job->first;
  return page;
}

absl::Status MemoryJobStore::Delete(const JobId& id) {
  const std::lock_guard lock(mutex_);
  const auto number = numbers_.find(id);
  if (number == numbers_.end()) return NoSuchJob(id);
  Erase(jobs_.find(number->second));
  return absl::OkStatus();
}

}  // namespace flatlight
