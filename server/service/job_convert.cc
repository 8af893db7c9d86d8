// SPDX-License-Identifier: Apache-2.0
#include "server/service/job_convert.h"

#include <chrono>

#include "server/convert/record_convert.h"
#include "server/convert/result_convert.h"
#include "server/convert/settings_convert.h"
#include "server/service/status_convert.h"
#include "server/store/error.h"
#include "server/store/sha256.h"

namespace flatlight {
namespace {

v1::Job::State PhaseToProto(JobPhase phase) {
  switch (phase) {
    case JobPhase::kQueued:
      return v1::Job::QUEUED;
    case JobPhase::kRunning:
      return v1::Job::RUNNING;
    case JobPhase::kPaused:
      return v1::Job::PAUSED;
    case JobPhase::kSucceeded:
      return v1::Job::SUCCEEDED;
    case JobPhase::kFailed:
      return v1::Job::FAILED;
    case JobPhase::kCancelled:
      return v1::Job::CANCELLED;
  }
  return v1::Job::STATE_UNSPECIFIED;
}

void FillProgress(const JobState& state, v1::Progress& out) {
  const RenderProgress& progress = state.progress;
  out.set_fraction(progress.fraction);
  out.set_samples(progress.samples);
  out.set_rays(progress.rays);
  out.set_elapsed_seconds(state.elapsed_seconds);
  if (progress.remaining_seconds && !HasEnded(state.phase)) out.set_remaining_seconds(*progress.remaining_seconds);
  out.set_records(progress.records);
  if (progress.relative_error) out.set_relative_error(*progress.relative_error);
}

v1::QueuePlace::Reason ReasonToProto(QueuePlace::Reason reason) {
  switch (reason) {
    case QueuePlace::Reason::kServerFull:
      return v1::QueuePlace::SERVER_FULL;
    case QueuePlace::Reason::kOwnJobs:
      return v1::QueuePlace::OWN_JOBS;
    case QueuePlace::Reason::kDayUsedUp:
      return v1::QueuePlace::DAY_USED_UP;
  }
  return v1::QueuePlace::REASON_UNSPECIFIED;
}

}  // namespace

v1::JobClass JobClassToProto(JobClass job_class) {
  switch (job_class) {
    case JobClass::kInteractive:
      return v1::INTERACTIVE;
    case JobClass::kGraded:
      return v1::GRADED;
    case JobClass::kRegrade:
      return v1::REGRADE;
  }
  return v1::JOB_CLASS_UNSPECIFIED;
}

void SetTime(WallTime time, google::protobuf::Timestamp& out) {
  using std::chrono::duration_cast;
  using std::chrono::nanoseconds;
  using std::chrono::seconds;
  const auto since_epoch = time.time_since_epoch();
  const auto whole = std::chrono::floor<seconds>(since_epoch);
  out.set_seconds(whole.count());
  out.set_nanos(static_cast<std::int32_t>(duration_cast<nanoseconds>(since_epoch - whole).count()));
}

// Threads and skips do not.
std::string JobKey(const JobSpec& spec, const std::string& build) {
  v1::Settings settings = SettingsToProto(spec.plan.settings);
  settings.clear_threads();
  settings.clear_no_skip();
  Sha256 hash;
  hash.Add(spec.scene->world_hash);
  hash.Add(spec.scene->probe_hash);
  hash.Add(settings.SerializeAsString());
  hash.Add(build);
  if (spec.records_checksum) hash.Add(*spec.records_checksum);
  return hash.Finish();
}

v1::Job JobToProto(const JobSpec& spec, const JobState& state, JobView view) {
  v1::Job job;
  job.set_name(spec.id.Name());
  if (view == JobView::kWhole) {
    job.set_scene(spec.scene->name);
    *job.mutable_settings() = SettingsToProto(spec.settings);
    *job.mutable_plan() = PlanToProto(spec.plan);
    job.set_job_class(JobClassToProto(spec.job_class));
    job.set_owner(spec.owner);
  }
  if (state.queue) {
    job.mutable_queue()->set_reason(ReasonToProto(state.queue->reason));
    job.mutable_queue()->set_ahead(static_cast<double>(state.queue->ahead));
    if (state.queue->expected_start)
      SetTime(*state.queue->expected_start, *job.mutable_queue()->mutable_expected_start());
  }
  job.set_state(PhaseToProto(state.phase));
  job.set_shared_work(state.shared_work);
  FillProgress(state, *job.mutable_progress());
  SetTime(spec.create_time, *job.mutable_create_time());
  if (state.start_time) SetTime(*state.start_time, *job.mutable_start_time());
  if (state.end_time) SetTime(*state.end_time, *job.mutable_end_time());
  if (state.expire_time) SetTime(*state.expire_time, *job.mutable_expire_time());
  if (state.end_reason) job.set_end_reason(EndReasonToProto(*state.end_reason));
  if (!state.error.ok()) *job.mutable_error() = ToRpcStatus(state.error);
  return job;
}

absl::StatusOr<Grantee> GranteeFromProto(const std::string& path, const std::string& text) {
  if (auto grantee = Grantee::Parse(text)) return *std::move(grantee);
  return MakeFieldError(path, "\"" + text + "\"; allowed: user:NAME, group:NAME, course");
}

absl::StatusOr<Grant> GrantFromProto(const v1::Share& share) {
  auto grantee = GranteeFromProto("share.grantee", share.grantee());
  if (!grantee.ok()) return grantee.status();
  switch (share.access()) {
    case v1::Share::ACCESS_UNSPECIFIED:
    case v1::Share::READ:
      return Grant{*std::move(grantee), Access::kRead};
    case v1::Share::CONTROL:
      return Grant{*std::move(grantee), Access::kControl};
    default:
      return MakeFieldError("share.access", std::to_string(share.access()) + "; allowed: READ, CONTROL");
  }
}

v1::Share GrantToProto(const Grant& grant) {
  v1::Share share;
  share.set_grantee(grant.grantee.text());
  share.set_access(grant.access == Access::kControl ? v1::Share::CONTROL : v1::Share::READ);
  return share;
}

absl::StatusOr<v1::RenderResult> MakeResult(const JobRecord& job, const std::string& build) {
  const JobSpec& spec = *job.spec;
  const JobState& state = *job.state;
  if (!HasEnded(state.phase)) {
    return MakeError(absl::StatusCode::kFailedPrecondition, "JOB_NOT_ENDED",
                     spec.id.Name() + " has not ended; watch it until it has, or cancel it");
  }
  if (state.field == nullptr) {
    return MakeError(absl::StatusCode::kFailedPrecondition, "NO_RESULT",
                     spec.id.Name() + " ended before anything was rendered");
  }
  v1::RenderResult result = ResultToProto(*spec.scene, *state.field);
  result.set_job_key(spec.job_key);
  result.set_build(build);
  *result.mutable_settings() = SettingsToProto(spec.settings);
  *result.mutable_plan() = PlanToProto(spec.plan);
  if (!result.records().empty())
    *result.mutable_records_seal() = SealOf(spec.scene->world_hash, spec.plan.settings, result.records());
  if (state.end_reason) result.set_end_reason(EndReasonToProto(*state.end_reason));
  result.mutable_statistics()->set_wall_seconds(state.elapsed_seconds);
  result.mutable_statistics()->set_cpu_seconds(state.cpu_seconds);
  return result;
}

absl::StatusOr<JobClass> JobClassFromProto(v1::JobClass job_class) {
  switch (job_class) {
    case v1::JOB_CLASS_UNSPECIFIED:
    case v1::INTERACTIVE:
      return JobClass::kInteractive;
    case v1::GRADED:
      return JobClass::kGraded;
    case v1::REGRADE:
      return JobClass::kRegrade;
    default:
      return MakeFieldError("job_class", std::to_string(job_class) + "; allowed: INTERACTIVE, GRADED, REGRADE");
  }
}

absl::StatusOr<JobId> ParseJobName(const std::string& name) {
  if (const auto id = JobId::FromName(name)) return *id;
  return MakeFieldError("name", "\"" + name + "\"; a job is named jobs/{uuid}");
}

}  // namespace flatlight
