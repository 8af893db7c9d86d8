// SPDX-License-Identifier: Apache-2.0
#include "server/service/render_service.h"

#include <memory>
#include <utility>

#include "server/service/call.h"
#include "server/service/job_convert.h"
#include "server/service/job_watch.h"
#include "server/service/refused_stream.h"
#include "server/service/render_calls.h"
#include "server/service/result_stream.h"
#include "server/service/scene_lane.h"
#include "server/service/stream_caller.h"

namespace flatlight {
namespace {

constexpr double kDefaultRate = 20;
constexpr double kMaxRate = 1000;

constexpr auto kQuickLane = [](const auto&) { return Lane::kQuick; };

}  // namespace

grpc::ServerUnaryReactor* RenderService::CreateJob(Context* context, const Bytes* request, Bytes* response) {
  const auto lane = [this](const Caller& caller, const v1::CreateJobRequest& r) {
    return LaneOf(caller, r.scene(), backend_.scenes);
  };
  return Answer<v1::CreateJobRequest>(
      backend_, context, request, response, lane, [this, context](const Caller& caller, const v1::CreateJobRequest& r) {
        return flatlight::CreateJob(backend_, caller, r, WhileWanted(backend_, *context));
      });
}

grpc::ServerUnaryReactor* RenderService::GetJob(Context* context, const Bytes* request, Bytes* response) {
  const auto lane = [this](const v1::GetJobRequest& r) {
    const auto id = ParseJobName(r.name());
    return !id.ok() || backend_.jobs.IsAtHand(*id) ? Lane::kInline : Lane::kQuick;
  };
  return Answer<v1::GetJobRequest>(
      backend_, context, request, response, lane,
      [this](const Caller& caller, const v1::GetJobRequest& r) { return flatlight::GetJob(backend_, caller, r); });
}

grpc::ServerUnaryReactor* RenderService::ListJobs(Context* context, const Bytes* request, Bytes* response) {
  return Answer<v1::ListJobsRequest>(
      backend_, context, request, response, kQuickLane,
      [this](const Caller& caller, const v1::ListJobsRequest& r) { return flatlight::ListJobs(backend_, caller, r); });
}

grpc::ServerUnaryReactor* RenderService::CancelJob(Context* context, const Bytes* request, Bytes* response) {
  return Answer<v1::CancelJobRequest>(backend_, context, request, response, kQuickLane,
                                      [this](const Caller& caller, const v1::CancelJobRequest& r) {
                                        return flatlight::CancelJob(backend_, caller, r);
                                      });
}

grpc::ServerUnaryReactor* RenderService::PauseJob(Context* context, const Bytes* request, Bytes* response) {
  return Answer<v1::PauseJobRequest>(
      backend_, context, request, response, kQuickLane,
      [this](const Caller& caller, const v1::PauseJobRequest& r) { return flatlight::PauseJob(backend_, caller, r); });
}

grpc::ServerUnaryReactor* RenderService::ResumeJob(Context* context, const Bytes* request, Bytes* response) {
  return Answer<v1::ResumeJobRequest>(backend_, context, request, response, kQuickLane,
                                      [this](const Caller& caller, const v1::ResumeJobRequest& r) {
                                        return flatlight::ResumeJob(backend_, caller, r);
                                      });
}

grpc::ServerUnaryReactor* RenderService::DeleteJob(Context* context, const Bytes* request, Bytes* response) {
  return Answer<v1::DeleteJobRequest>(backend_, context, request, response, kQuickLane,
                                      [this](const Caller& caller, const v1::DeleteJobRequest& r) {
                                        return flatlight::DeleteJob(backend_, caller, r);
                                      });
}

grpc::ServerUnaryReactor* RenderService::ShareJob(Context* context, const Bytes* request, Bytes* response) {
  return Answer<v1::ShareJobRequest>(
      backend_, context, request, response, kQuickLane,
      [this](const Caller& caller, const v1::ShareJobRequest& r) { return flatlight::ShareJob(backend_, caller, r); });
}

grpc::ServerUnaryReactor* RenderService::UnshareJob(Context* context, const Bytes* request, Bytes* response) {
  return Answer<v1::UnshareJobRequest>(backend_, context, request, response, kQuickLane,
                                       [this](const Caller& caller, const v1::UnshareJobRequest& r) {
                                         auto job = flatlight::UnshareJob(backend_, caller, r);
                                         if (job.ok()) hub_.AccessChanged(r.name());
                                         return job;
                                       });
}

grpc::ServerUnaryReactor* RenderService::ExplainJob(Context* context, const Bytes* request, Bytes* response) {
  const auto lane = [this](const Caller& caller, const v1::ExplainJobRequest& r) {
    return LaneOf(caller, r.scene(), backend_.scenes);
  };
  return Answer<v1::ExplainJobRequest>(backend_, context, request, response, lane,
                                       [this, context](const Caller& caller, const v1::ExplainJobRequest& r) {
                                         return flatlight::ExplainJob(backend_, caller, r,
                                                                      WhileWanted(backend_, *context));
                                       });
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* RenderService::WatchJob(Context* context, const Bytes* request) {
  const auto watch = StartWatch(*context, *request);
  if (!watch.ok()) return new RefusedStream(watch.status());
  return watch->get();
}

absl::StatusOr<std::shared_ptr<JobWatch>> RenderService::StartWatch(const Context& context, const Bytes& bytes) {
  const auto caller = AdmitStream(backend_, context, v1::WatchJobRequest::descriptor()->name());
  if (!caller.ok()) return caller.status();
  v1::WatchJobRequest request;
  if (absl::Status parsed = FromBytes(bytes, request); !parsed.ok()) return parsed;
  backend_.telemetry.NoteResource(context, request.name());
  const auto id = ParseJobName(request.name());
  if (!id.ok()) return id.status();
  const double rate = request.has_max_rate() ? request.max_rate() : kDefaultRate;
  if (!(rate > 0 && rate <= kMaxRate)) {
    return MakeFieldError("max_rate", std::to_string(rate) + "; allowed: more than 0, at most 1000 (updates a second)");
  }
  const auto job = backend_.access.FindSeen(*caller, *id);
  if (!job.ok()) return job.status();
  WatchUpdate::Known known;
  if (request.epoch() == hub_.options().epoch && request.sequence() > 0) {
    known = request.sequence();
    if (*known > job->state->sequence) {
      return MakeError(absl::StatusCode::kOutOfRange, "SEQUENCE_AHEAD",
                       "sequence is " + std::to_string(*known) + "; " + request.name() + " is at " +
                           std::to_string(job->state->sequence));
    }
  }
  // Slow enough rates mean: only the first state and the last.
  const double seconds = std::min(1 / rate, 1e6);
  const auto interval = std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(seconds));
  Watch::Hooks hooks;
  hooks.watcher = caller->name;
  hooks.is_known = [this, caller = *caller] { return backend_.guard.Recheck(caller); };
  if (request.cancel_on_disconnect()) {
    const auto may_cancel = [this, caller = *caller, id = *id] {
      if (absl::Status is_known = backend_.guard.Recheck(caller); !is_known.ok()) return is_known;
      return backend_.access.CheckRight(caller, JobRight::kControl, id);
    };
    if (absl::Status allowed = may_cancel(); !allowed.ok()) return allowed;
    hooks.on_disconnect = [this, id = *id, may_cancel] {
      if (may_cancel().ok()) backend_.scheduler.RequestCancel(id);
    };
  }
  if (RightByRole(*caller, *job->spec) == JobRight::kNone) {
    hooks.may_see = [this, caller = *caller, id = *id] { return backend_.access.FindSeen(caller, id).status(); };
  }
  auto watch = std::make_shared<JobWatch>(hub_, *id, known, interval, std::move(hooks));
  if (absl::Status added = hub_.Add(id->Name(), watch, backend_.guard.QuotasOf(*caller).watches); !added.ok())
    return added;
  if (known) ++hub_.counts().resumed;
  return watch;
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* RenderService::GetResult(Context* context, const Bytes* bytes) {
  const auto caller = AdmitStream(backend_, *context, v1::GetResultRequest::descriptor()->name());
  if (!caller.ok()) return new RefusedStream(caller.status());
  v1::GetResultRequest request;
  if (absl::Status parsed = FromBytes(*bytes, request); !parsed.ok()) return new RefusedStream(parsed);
  backend_.telemetry.NoteResource(*context, request.name());
  const auto id = ParseJobName(request.name());
  if (!id.ok()) return new RefusedStream(id.status());
  auto stream = std::make_unique<ResultStream>(backend_.calls.Enter());
  const absl::Status posted = PostTo(backend_.quick, 0, [this, caller = *caller, id = *id, stream = stream.get()] {
    const auto job = backend_.access.FindSeen(caller, id);
    if (!job.ok()) return stream->Fail(ToGrpcStatus(job.status()));
    auto result = results_.Get(id, [&]() -> ResultCache::Bytes {
      auto written = backend_.jobs.WrittenResult(id);
      if (!written.ok() || *written != nullptr) return written;
      const auto made = MakeResult(*job, backend_.version);
      if (!made.ok()) return made.status();
      return std::make_shared<const std::string>(made->SerializeAsString());
    });
    if (!result.ok()) return stream->Fail(ToGrpcStatus(result.status()));
    stream->Send(*std::move(result));
  });
  if (!posted.ok()) return new RefusedStream(posted);
  return stream.release();
}

}  // namespace flatlight
