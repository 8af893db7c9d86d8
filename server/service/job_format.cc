// SPDX-License-Identifier: Apache-2.0
#include "server/service/job_format.h"

#include <memory>

#include "server/convert/result_read.h"
#include "server/convert/settings_convert.h"
#include "server/service/job_convert.h"
#include "server/service/status_convert.h"
#include "server/service/webhook_calls.h"
#include "server/store/error.h"

namespace flatlight {
namespace {

JobPhase PhaseOf(v1::Job::State state) {
  switch (state) {
    case v1::Job::SUCCEEDED:
      return JobPhase::kSucceeded;
    case v1::Job::FAILED:
      return JobPhase::kFailed;
    case v1::Job::CANCELLED:
      return JobPhase::kCancelled;
    default:
      return JobPhase::kQueued;
  }
}

WallTime TimeOf(const google::protobuf::Timestamp& time) {
  const auto since_epoch = std::chrono::seconds(time.seconds()) + std::chrono::nanoseconds(time.nanos());
  return WallTime(std::chrono::duration_cast<WallTime::duration>(since_epoch));
}

RenderProgress ProgressOf(const v1::Progress& source) {
  RenderProgress progress;
  progress.fraction = source.fraction();
  progress.samples = source.samples();
  progress.rays = source.rays();
  if (source.has_relative_error()) progress.relative_error = source.relative_error();
  return progress;
}

absl::Status Damaged(const ArchivedJob& job, const char* what) {
  return MakeError(absl::StatusCode::kDataLoss, "STORAGE_DAMAGED",
                   job.id.Name() + " has a damaged " + what + "; restore it from a backup");
}

}  // namespace

std::string ProtoJobFormat::WriteMessage(const JobRecord& job) const {
  v1::Job message = JobToProto(*job.spec, *job.state, JobView::kWhole);
  if (!job.spec->webhook.empty()) message.mutable_webhook()->set_url(job.spec->webhook);
  return message.SerializeAsString();
}

std::string ProtoJobFormat::WriteEvent(const JobRecord& job) const { return WebhookBody(job, build_); }

std::optional<std::string> ProtoJobFormat::WriteResult(const JobRecord& job) const {
  const auto result = MakeResult(job, build_);
  if (!result.ok()) return std::nullopt;
  return result->SerializeAsString();
}

absl::StatusOr<JobRecord> ProtoJobFormat::Read(const ArchivedJob& archived, const std::string* result_bytes) const {
  v1::Job job;
  if (!job.ParseFromString(archived.message)) return Damaged(archived, "description");
  v1::RenderResult result;
  if (result_bytes != nullptr && !result.ParseFromString(*result_bytes)) return Damaged(archived, "result");

  auto spec = std::make_shared<JobSpec>();
  auto state = std::make_shared<JobState>();
  spec->id = archived.id;
  spec->owner = archived.owner;
  auto outline = std::make_shared<SceneOutline>(OutlineOf(result));
  outline->name = job.scene();
  Diagnostics diagnostics;  // There are none: these were checked before they were written.
  spec->job_class = JobClassFromProto(job.job_class()).value_or(JobClass::kInteractive);
  spec->settings = SettingsFromProto(job.settings(), diagnostics);
  spec->plan = PlanFromProto(job.plan());
  spec->job_key = result.job_key();
  spec->webhook = job.webhook().url();
  spec->create_time = TimeOf(job.create_time());
  state->sequence = archived.sequence;
  state->phase = PhaseOf(job.state());
  state->shared_work = job.shared_work();
  state->progress = ProgressOf(job.progress());
  state->elapsed_seconds = job.progress().elapsed_seconds();
  state->cpu_seconds = result.statistics().cpu_seconds();
  if (job.has_start_time()) state->start_time = TimeOf(job.start_time());
  if (job.has_end_time()) {
    state->end_time = TimeOf(job.end_time());
    state->expire_time = retention_.ExpireTime(spec->job_class, *state->end_time);
  }
  state->end_reason = EndReasonFromProto(job.end_reason());
  if (job.has_error()) state->error = FromRpcStatus(job.error());
  if (result_bytes != nullptr) {
    state->field = std::make_shared<Field>(FieldOf(result));
    // A watcher that knows an earlier state gets everything.
    for (const Probe& probe : outline->probes) {
      const std::size_t runs = (probe.points() + FieldVersions::kPoints - 1) / FieldVersions::kPoints;
      state->versions.changed.emplace_back(runs, archived.sequence);
    }
  }
  spec->scene = std::move(outline);
  return JobRecord{std::move(spec), std::move(state)};
}

}  // namespace flatlight
