// SPDX-License-Identifier: Apache-2.0
// Of Scheduler: what owners may have, and what becomes of jobs whose owner has had it.
#include <algorithm>
#include <chrono>
#include <ctime>
#include <utility>

#include "server/scheduler/scheduler.h"
#include "server/store/error.h"

namespace flatlight {
namespace {

constexpr std::chrono::milliseconds kRetryLater{2000};

std::string WholeSeconds(double seconds) { return std::to_string(static_cast<std::int64_t>(seconds)); }

absl::Status DayUsedUp(double used, double allowed, std::chrono::milliseconds until_tomorrow) {
  return MakeQuotaError("PROCESSOR_TIME_USED_UP", "max_cpu_seconds_per_day",
                        "your jobs have had " + WholeSeconds(used) + " s of processor time today; allowed: " +
                            WholeSeconds(allowed) + " s a day. The next day begins at 00:00 UTC",
                        until_tomorrow, QuotaUse{used, allowed});
}

}  // namespace

void Scheduler::FreeQuota(const std::string& owner) {
  if (const auto entry = owners_.find(owner); --entry->second.jobs == 0) owners_.erase(entry);
}

std::size_t Scheduler::JobsOf(const std::string& owner) {
  const std::lock_guard lock(mutex_);
  const auto entry = owners_.find(owner);
  return entry == owners_.end() ? 0 : entry->second.jobs;
}

absl::Status Scheduler::CheckQuota(const std::string& owner, const Quotas& quotas) {
  const auto entry = owners_.find(owner);
  const std::size_t jobs = entry == owners_.end() ? 0 : entry->second.jobs;
  if (quotas.jobs && jobs >= *quotas.jobs) {
    return MakeQuotaError("TOO_MANY_JOBS", "max_jobs_per_user",
                          std::to_string(jobs) + " of your jobs have not ended; allowed: " +
                              std::to_string(*quotas.jobs) + ". Wait for one, or cancel one",
                          kRetryLater, QuotaUse{static_cast<double>(jobs), static_cast<double>(*quotas.jobs)});
  }
  if (options_.ledger == nullptr) return absl::OkStatus();
  const double used = options_.ledger->UsedToday(owner);
  if (quotas.cpu_seconds && used >= *quotas.cpu_seconds) {
    return DayUsedUp(used, *quotas.cpu_seconds, options_.ledger->UntilTomorrow());
  }
  // It may have got more than it had.
  if (IsSpent(owner)) LeaveRest([&](const std::string& other) { return other == owner; });
  return absl::OkStatus();
}

void Scheduler::Charge(const std::string& owner, double cpu_seconds) {
  accounts_.Charge(owner, cpu_seconds);
  if (options_.ledger == nullptr) return;
  CheckDay(owner, options_.ledger->Charge(owner, cpu_seconds));
}

void Scheduler::CheckDay(const std::string& owner, double used) {
  if (IsSpent(owner)) return;
  const auto entry = owners_.find(owner);
  if (entry == owners_.end() || !entry->second.quotas.cpu_seconds) return;
  if (used < *entry->second.quotas.cpu_seconds) return;
  spent_.insert(owner);
  spent_day_ = options_.ledger->Today();
  std::vector<RunPtr> runs;
  for (const auto& [id, run] : runs_) {
    if (run->spec->owner == owner) runs.push_back(run);
  }
  for (const RunPtr& run : runs) {
    switch (run->stage) {
      case JobRun::Stage::kWaiting:
      case JobRun::Stage::kReady:
        if (run->state.phase != JobPhase::kPaused && !run->cancellation.cancelled()) EnterRest(*run);
        break;
      case JobRun::Stage::kPreparing:
        SendAway(*run);  // It rests itself when that is done.
        break;
      case JobRun::Stage::kFollowing:  // It costs nothing.
      case JobRun::Stage::kSlicing:    // When the slice has ended.
      case JobRun::Stage::kEnded:
        break;
    }
  }
}

void Scheduler::EnterRest(JobRun& run) {
  SendAway(run);
  QueuePlace place;
  place.reason = QueuePlace::Reason::kDayUsedUp;
  place.expected_start = options_.ledger->EndOfToday();
  if (run.state.queue == place) return;
  run.state.phase = JobPhase::kQueued;
  run.state.queue = place;
  Publish(run);
}

void Scheduler::LeaveRest(const std::function<bool(const std::string& owner)>& whose) {
  std::erase_if(spent_, whose);
  std::vector<RunPtr> runs;
  for (const auto& [id, run] : runs_) {
    if (run->state.queue && run->state.queue->reason == QueuePlace::Reason::kDayUsedUp && whose(run->spec->owner)) {
      runs.push_back(run);
    }
  }
  for (const RunPtr& run : runs) {
    run->state.queue.reset();
    if (run->stage == JobRun::Stage::kReady) run->state.phase = JobPhase::kRunning;
    Publish(*run);
  }
  Admit();
  ready_changed_.notify_all();
}

bool Scheduler::MaybeBeginDay() {
  if (spent_.empty() || options_.ledger->Today() == spent_day_) return false;
  LeaveRest([](const std::string&) { return true; });
  return true;
}

}  // namespace flatlight
