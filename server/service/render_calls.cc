// SPDX-License-Identifier: Apache-2.0
#include "server/service/render_calls.h"

#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/render/plan.h"
#include "server/convert/scene_reader.h"
#include "server/convert/settings_convert.h"
#include "server/service/job_access.h"
#include "server/service/job_convert.h"
#include "server/service/known_records.h"
#include "server/service/message_bytes.h"
#include "server/service/page.h"
#include "server/service/quota_calls.h"
#include "server/service/scene_source.h"
#include "server/service/status_convert.h"
#include "server/service/webhook_calls.h"
#include "server/store/error.h"
#include "server/store/sha256.h"

namespace flatlight {
namespace {

constexpr std::size_t kMaxRequestIdBytes = 128;
// Of a list of jobs, unless one alone is longer. Clients of gRPC take 4 MiB.
constexpr std::size_t kMaxPageBytes = 1u << 20;

struct PlannedScene {
  std::shared_ptr<const Scene> scene;
  Settings settings;
  Plan plan;
};

// A request may name one skip very often; the job, which is sent often, need not.
void DropRepeats(std::vector<std::string>& names) {
  std::set<std::string> seen;
  std::erase_if(names, [&](const std::string& name) { return !seen.insert(name).second; });
}

// Every mistake of the scene and of the settings is reported at once.
absl::StatusOr<PlannedScene> MakePlannedScene(Backend& backend, const Caller& caller, const v1::SceneSource& source,
                                              const v1::Settings& settings, const Proceed& proceed) {
  PlannedScene planned;
  Diagnostics scene_diagnostics;
  auto scene =
      LoadScene(source, {caller, backend.scenes, backend.built_scenes, backend.limits}, proceed, scene_diagnostics);
  if (!scene.ok()) return scene.status();
  planned.scene = *std::move(scene);
  Diagnostics diagnostics = scene_diagnostics;
  planned.settings = SettingsFromProto(settings, diagnostics);
  std::optional<Plan> plan;
  if (planned.scene != nullptr && diagnostics.empty()) plan = MakePlan(*planned.scene, planned.settings, diagnostics);
  if (!scene_diagnostics.empty()) return MakeDiagnosticsError("BAD_SCENE", "the scene", diagnostics);
  if (!plan) return MakeDiagnosticsError("BAD_SETTINGS", "the settings", diagnostics);
  planned.plan = *std::move(plan);
  DropRepeats(planned.settings.no_skip);
  DropRepeats(planned.plan.settings.no_skip);
  const auto threads = static_cast<std::uint32_t>(backend.threads);
  planned.plan.settings.threads = std::min(planned.settings.threads.value_or(threads), threads);
  return planned;
}

absl::StatusOr<std::optional<RequestKey>> KeyOf(const Caller& caller, const v1::CreateJobRequest& request) {
  if (request.request_id().empty()) return std::optional<RequestKey>();
  if (request.request_id().size() > kMaxRequestIdBytes) {
    return MakeFieldError("request_id", std::to_string(request.request_id().size()) + " bytes; allowed: at most " +
                                            std::to_string(kMaxRequestIdBytes));
  }
  v1::CreateJobRequest rest = request;
  rest.clear_request_id();
  return std::optional<RequestKey>(
      {caller.name, "CreateJob", request.request_id(), Sha256Of(rest.SerializeAsString())});
}

// With whom a job may share work, and what is known of its world: with those that have an equal answer here.
std::string Sharers(Backend& backend, const v1::CreateJobRequest& request, const std::string& owner) {
  if (request.scene().has_name() && request.scene().probes().empty()) {
    if (const auto named = FindScene(request.scene().name(), backend.scenes); named.ok() && named->info.gallery()) {
      return "everybody";
    }
  }
  return "user " + owner;
}

// The job that a request of `caller` asks for.
absl::StatusOr<JobRun::Restored> MakeJob(Backend& backend, const Caller& caller, const v1::CreateJobRequest& request,
                                         JobSpec spec, const Proceed& proceed) {
  auto planned = MakePlannedScene(backend, caller, request.scene(), request.settings(), proceed);
  if (!planned.ok()) return planned.status();
  if (request.has_records()) {
    auto taken = TakeRecords(request.records(), *planned->scene, planned->plan);
    if (!taken.ok()) return taken.status();
    planned->plan.known_records = std::move(taken->records);
    spec.records_checksum = std::move(taken->checksum);
  }
  spec.scene = std::make_shared<SceneOutline>(*planned->scene);
  spec.settings = std::move(planned->settings);
  spec.plan = std::move(planned->plan);
  spec.job_key = JobKey(spec, backend.version);
  spec.sharers = Sharers(backend, request, spec.owner);
  spec.webhook = request.webhook();
  // Where a time limit ends a job is never the same.
  if (!request.anew() && !spec.plan.settings.time_limit) spec.work_key = spec.job_key + ' ' + spec.sharers;
  return JobRun::Restored{std::make_shared<JobSpec>(std::move(spec)), std::move(planned->scene), {}};
}

// With the records of the job that it names: that job may be deleted before this one is restored.
absl::StatusOr<v1::CreateJobRequest> WithRecords(const Caller& caller, const v1::CreateJobRequest& request,
                                                 const JobAccess& jobs) {
  auto records = RecordsOfJob(caller, request.records(), jobs);
  if (!records.ok()) return records.status();
  v1::CreateJobRequest whole = request;
  *whole.mutable_records() = *std::move(records);
  return whole;
}

// What RestoreJob makes the same job from, whatever becomes of uploaded scenes.
absl::StatusOr<Submission> MakeSubmission(Backend& backend, const v1::CreateJobRequest& request) {
  Submission submission;
  submission.request = request.SerializeAsString();
  if (!request.scene().has_name()) return submission;
  const auto named = FindScene(request.scene().name(), backend.scenes);
  if (!named.ok()) return named.status();
  if (named->info.gallery()) return submission;
  submission.scene_sha256 = SceneIdOf(request.scene().name());
  submission.scene = named->json;
  return submission;
}

v1::Job WholeJob(const JobRecord& job) { return JobToProto(*job.spec, *job.state, JobView::kWhole); }

// As who has made it sees it.
absl::StatusOr<v1::Job> CreatedJob(Backend& backend, const JobRecord& record) {
  v1::Job job = WholeJob(record);
  if (absl::Status told = TellWebhook(backend.webhooks, *record.spec, job); !told.ok()) return told;
  return job;
}

// Adds its shares and its webhook, which are for those who may change them.
absl::Status TellOwner(Backend& backend, const Caller& caller, const JobSpec& spec, v1::Job& job) {
  if (RightByRole(caller, spec) < JobRight::kOwn) return absl::OkStatus();
  if (absl::Status told = TellWebhook(backend.webhooks, spec, job); !told.ok()) return told;
  const auto grants = backend.jobs.GrantsOf(spec.id);
  if (!grants.ok()) return grants.status();
  for (const Grant& grant : *grants) *job.add_shares() = GrantToProto(grant);
  return absl::OkStatus();
}

template <class Action>
absl::StatusOr<v1::Job> ChangeShares(Backend& backend, const Caller& caller, const std::string& name,
                                     const Action& action) {
  const auto id = ParseJobName(name);
  if (!id.ok()) return id.status();
  if (absl::Status allowed = backend.access.CheckRight(caller, JobRight::kOwn, *id); !allowed.ok()) return allowed;
  if (absl::Status changed = action(*id); !changed.ok()) return changed;
  const auto record = backend.jobs.Get(*id);
  if (!record.ok()) return record.status();
  v1::Job job = WholeJob(*record);
  if (absl::Status told = TellOwner(backend, caller, *record->spec, job); !told.ok()) return told;
  return job;
}

template <class Action>
absl::StatusOr<v1::Job> ControlJob(Backend& backend, const Caller& caller, const std::string& name,
                                   const Action& action) {
  const auto id = ParseJobName(name);
  if (!id.ok()) return id.status();
  if (absl::Status allowed = backend.access.CheckRight(caller, JobRight::kControl, *id); !allowed.ok()) return allowed;
  const absl::StatusOr<JobRecord> job = action(*id);
  if (!job.ok()) return job.status();
  return WholeJob(*job);
}

}  // namespace

absl::StatusOr<v1::Job> CreateJob(Backend& backend, const Caller& caller, const v1::CreateJobRequest& request,
                                  const Proceed& proceed) {
  if (backend.draining) return MakeDrainingError();
  const auto job_class = JobClassFromProto(request.job_class());
  if (!job_class.ok()) return job_class.status();
  const auto key = KeyOf(caller, request);
  if (!key.ok()) return key.status();
  if (*key) {
    const auto earlier = backend.jobs.FindRequest(**key);
    if (!earlier.ok()) return earlier.status();
    if (*earlier) {
      const auto job = backend.jobs.Get(**earlier);
      if (!job.ok()) return job.status();
      return CreatedJob(backend, *job);
    }
  }
  const Quotas& quotas = backend.guard.QuotasOf(caller);
  if (quotas.storage_bytes) {
    const std::uint64_t used = StorageOf(backend, caller.name);
    if (used >= *quotas.storage_bytes) return StorageUsedUp(used, *quotas.storage_bytes, 0);
  }
  // Scenes may be large: a copy only where something is added.
  absl::StatusOr<v1::CreateJobRequest> with_records;
  const v1::CreateJobRequest* whole = &request;
  if (!request.records().job().empty()) {
    with_records = WithRecords(caller, request, backend.access);
    if (!with_records.ok()) return with_records.status();
    whole = &*with_records;
  }
  JobSpec spec;
  spec.id = JobId::Random();
  spec.owner = caller.name;
  spec.job_class = *job_class;
  spec.create_time = std::chrono::system_clock::now();
  if (!request.webhook().empty()) {
    if (absl::Status allowed = CheckWebhook(backend, caller, request.webhook()); !allowed.ok()) return allowed;
  }
  auto made = MakeJob(backend, caller, *whole, std::move(spec), proceed);
  if (!made.ok()) return made.status();
  absl::StatusOr<Submission> submission = Submission{};
  if (backend.jobs.durable()) submission = MakeSubmission(backend, *whole);
  if (!submission.ok()) return submission.status();
  submission->webhook = request.webhook();
  const auto job = backend.scheduler.Submit(std::move(made->spec), std::move(made->scene), *submission, *key, quotas);
  if (!job.ok()) return job.status();
  return CreatedJob(backend, *job);
}

absl::StatusOr<JobRun::Restored> RestoreJob(Backend& backend, JobArchive& archive, const JobSpec& accepted) {
  const auto submission = archive.FetchSubmission(accepted.id);
  if (!submission.ok()) return submission.status();
  v1::CreateJobRequest request;
  if (!request.ParseFromString(submission->request)) {
    return MakeError(absl::StatusCode::kDataLoss, "STORAGE_DAMAGED",
                     "the request that made " + accepted.id.Name() + " is damaged; create the job again");
  }
  if (submission->scene != nullptr) {
    v1::Scene scene;
    Diagnostics diagnostics;
    ReadSceneJson(*submission->scene, scene, diagnostics);
    if (!diagnostics.empty()) return MakeDiagnosticsError("BAD_SCENE", "the scene", diagnostics);
    *request.mutable_scene()->mutable_scene() = std::move(scene);
  }
  JobSpec spec;
  spec.id = accepted.id;
  spec.owner = accepted.owner;
  spec.job_class = accepted.job_class;
  spec.create_time = accepted.create_time;
  // It carries its scene, unless that is of the gallery: whatever has become of uploads, and of the owner's role.
  auto made =
      MakeJob(backend, {accepted.owner, Role::kStudent}, request, std::move(spec), [] { return absl::OkStatus(); });
  if (!made.ok()) return made.status();
  // Without its checkpoint a job begins anew, and ends with the same bits.
  if (auto checkpoint = archive.FetchCheckpoint(accepted.id); checkpoint.ok()) {
    made->checkpoint = std::move(*checkpoint).value_or("");
  }
  return made;
}

absl::StatusOr<grpc::ByteBuffer> GetJob(Backend& backend, const Caller& caller, const v1::GetJobRequest& request) {
  const auto id = ParseJobName(request.name());
  if (!id.ok()) return id.status();
  const auto job = backend.access.FindSeen(caller, *id);
  if (!job.ok()) return job.status();
  // A message's parts, one behind the other, are the message.
  v1::Job for_owner;
  if (absl::Status told = TellOwner(backend, caller, *job->spec, for_owner); !told.ok()) return told;
  const std::array<grpc::Slice, 2> parts = {backend.job_messages.Of(*job), ToSlice(for_owner)};
  return grpc::ByteBuffer(parts.data(), parts[1].size() == 0 ? 1 : 2);
}

absl::StatusOr<v1::ListJobsResponse> ListJobs(Backend& backend, const Caller& caller,
                                              const v1::ListJobsRequest& request) {
  if (request.shared() && request.own()) return MakeFieldError("own", "true; allowed: false, with shared");
  std::optional<std::string> owner;
  if (caller.role < Role::kGrader || request.own()) owner = caller.name;
  const std::string list = (request.shared() ? "jobs shared with "
                            : owner          ? "jobs of "
                                             : "all jobs, for ") +
                           caller.name;
  const auto page = ParsePage(backend.page_tokens, list, request.page_size(), request.page_token());
  if (!page.ok()) return page.status();
  const auto listed = request.shared() ? backend.jobs.ListShared(Grantee::Of(caller.name, caller.groups), caller.name,
                                                                 page->position, page->size)
                                       : backend.jobs.List(owner, page->position, page->size);
  if (!listed.ok()) return listed.status();
  const JobPage& jobs = *listed;
  v1::ListJobsResponse response;
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < jobs.jobs.size(); ++i) {
    v1::Job job = WholeJob(jobs.jobs[i]);
    bytes += job.ByteSizeLong();
    if (i > 0 && bytes > kMaxPageBytes) {
      response.set_next_page_token(backend.page_tokens.Seal(list, jobs.positions[i - 1]));
      return response;
    }
    *response.add_jobs() = std::move(job);
  }
  if (jobs.next_before) response.set_next_page_token(backend.page_tokens.Seal(list, *jobs.next_before));
  return response;
}

absl::StatusOr<v1::Job> CancelJob(Backend& backend, const Caller& caller, const v1::CancelJobRequest& request) {
  return ControlJob(backend, caller, request.name(), [&](const JobId& id) { return backend.scheduler.Cancel(id); });
}

absl::StatusOr<v1::Job> PauseJob(Backend& backend, const Caller& caller, const v1::PauseJobRequest& request) {
  return ControlJob(backend, caller, request.name(), [&](const JobId& id) { return backend.scheduler.Pause(id); });
}

absl::StatusOr<v1::Job> ResumeJob(Backend& backend, const Caller& caller, const v1::ResumeJobRequest& request) {
  return ControlJob(backend, caller, request.name(), [&](const JobId& id) { return backend.scheduler.Resume(id); });
}

absl::StatusOr<v1::DeleteJobResponse> DeleteJob(Backend& backend, const Caller& caller,
                                                const v1::DeleteJobRequest& request) {
  const auto id = ParseJobName(request.name());
  if (!id.ok()) return id.status();
  if (absl::Status allowed = backend.access.CheckRight(caller, JobRight::kOwn, *id); !allowed.ok()) return allowed;
  if (absl::Status deleted = backend.scheduler.Delete(*id); !deleted.ok()) return deleted;
  backend.job_messages.Forget(*id);
  return v1::DeleteJobResponse();
}

absl::StatusOr<v1::Job> ShareJob(Backend& backend, const Caller& caller, const v1::ShareJobRequest& request) {
  const auto grant = GrantFromProto(request.share());
  if (!grant.ok()) return grant.status();
  return ChangeShares(backend, caller, request.name(), [&](const JobId& id) { return backend.jobs.Share(id, *grant); });
}

absl::StatusOr<v1::Job> UnshareJob(Backend& backend, const Caller& caller, const v1::UnshareJobRequest& request) {
  const auto grantee = GranteeFromProto("grantee", request.grantee());
  if (!grantee.ok()) return grantee.status();
  return ChangeShares(backend, caller, request.name(),
                      [&](const JobId& id) { return backend.jobs.Unshare(id, *grantee); });
}

absl::StatusOr<v1::ExplainJobResponse> ExplainJob(Backend& backend, const Caller& caller,
                                                  const v1::ExplainJobRequest& request, const Proceed& proceed) {
  const auto planned = MakePlannedScene(backend, caller, request.scene(), request.settings(), proceed);
  if (!planned.ok()) return planned.status();
  v1::ExplainJobResponse response;
  *response.mutable_plan() = PlanToProto(planned->plan);
  return response;
}

}  // namespace flatlight
