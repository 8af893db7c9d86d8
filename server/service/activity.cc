// SPDX-License-Identifier: Apache-2.0
#include "server/service/activity.h"

#include <string>

#include "server/service/job_access.h"
#include "server/service/job_convert.h"
#include "server/service/status_convert.h"
#include "server/telemetry/process_readings.h"

namespace flatlight {
namespace {

constexpr std::uint32_t kDefaultJobs = 100;
constexpr std::uint32_t kMostJobs = 1000;
constexpr char kOthers[] = "(others)";  // No user's name.

void AddUser(const std::string& name, const SchedulerLoad::User& user, v1::GetActivityResponse& response) {
  v1::UserActivity& activity = *response.add_users();
  activity.set_user(name);
  activity.set_running(static_cast<std::uint32_t>(user.running));
  activity.set_waiting(static_cast<std::uint32_t>(user.waiting));
  activity.set_paused(static_cast<std::uint32_t>(user.paused));
  activity.set_cpu_seconds(user.cpu_seconds);
}

void AddJob(const JobRecord& record, v1::GetActivityResponse& response) {
  v1::JobActivity& activity = *response.add_jobs();
  activity.set_owner(record.spec->owner);
  v1::Job& job = *activity.mutable_job();
  job = JobToProto(*record.spec, *record.state, JobView::kWhole);
  activity.set_method(job.plan().settings().method());
  job.clear_settings();
  job.clear_plan();
}

}  // namespace

absl::StatusOr<v1::GetActivityResponse> GetActivity(Backend& backend, const Caller& caller,
                                                    const v1::GetActivityRequest& request) {
  if (request.max_jobs() > kMostJobs) {
    return MakeFieldError("max_jobs", std::to_string(request.max_jobs()) + "; allowed: at most 1000");
  }
  const CallTelemetry& telemetry = backend.telemetry;
  const ProcessReadings process = ReadProcess();
  const Readings now = telemetry.metrics().Read();
  v1::GetActivityResponse response;
  response.set_uptime_seconds(telemetry.uptime_seconds());
  response.set_cpu_seconds(process.cpu_seconds);
  response.set_job_cpu_seconds(telemetry.metrics().job_cpu_seconds());
  response.set_rays(telemetry.metrics().rays());
  response.set_resident_bytes(process.resident_bytes);
  response.set_heap_bytes(process.heap_bytes);
  response.set_watches(now.watches);
  SchedulerLoad::User others;
  bool has_others = false;
  for (const auto& [name, user] : now.load.users) {
    if (caller.role >= Role::kGrader || name == caller.name) {
      AddUser(name, user, response);
      continue;
    }
    has_others = true;
    others.running += user.running;
    others.waiting += user.waiting;
    others.paused += user.paused;
    others.cpu_seconds += user.cpu_seconds;
  }
  if (has_others) AddUser(kOthers, others, response);
  const std::uint32_t most = request.max_jobs() == 0 ? kDefaultJobs : request.max_jobs();
  for (const JobId& id : backend.scheduler.Unended(most)) {
    // It may have ended meanwhile.
    const auto job = backend.jobs.Get(id);
    if (!job.ok() || HasEnded(job->state->phase) || RightByRole(caller, *job->spec) == JobRight::kNone) continue;
    AddJob(*job, response);
  }
  return response;
}

}  // namespace flatlight
