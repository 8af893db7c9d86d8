// SPDX-License-Identifier: Apache-2.0
#include "client/cli/jobs/job_calls.h"

#include "client/cli/connection/message_stream.h"
#include "client/cli/formats/result_shape.h"
#include "client/cli/jobs/job_name.h"
#include "client/cli/status/exit_code.h"
#include "client/cli/status/rpc_error.h"

namespace flatlight {
namespace {

constexpr std::chrono::seconds kSilence{30};

// Also after a signal.
template <class Request, class Method>
absl::StatusOr<v1::Job> ControlJob(Connection& connection, Method method, const std::string& name) {
  Request request;
  request.set_name(name);
  return connection.Ask(connection.render(), method, request, Connection::OnSignal::kGoOn);
}

}  // namespace

absl::StatusOr<v1::Job> CreateJob(Connection& connection, const v1::SceneSource& scene, const v1::Settings& settings,
                                  const CreateJobOptions& options) {
  v1::CreateJobRequest request;
  *request.mutable_scene() = scene;
  *request.mutable_settings() = settings;
  request.set_job_class(options.job_class);
  if (options.records) *request.mutable_records() = *options.records;
  request.set_anew(options.anew);
  request.set_webhook(options.webhook);
  request.set_request_id(NewUuid());
  // It returns at once, and a job of which nobody knows could not be cancelled: so a signal has to wait.
  return connection.Ask(connection.render(), &v1::RenderService::Stub::CreateJob, request, Connection::OnSignal::kGoOn);
}

absl::StatusOr<v1::Job> GetJob(Connection& connection, const std::string& name) {
  v1::GetJobRequest request;
  request.set_name(name);
  return connection.Ask(connection.render(), &v1::RenderService::Stub::GetJob, request);
}

absl::StatusOr<v1::Job> CancelJob(Connection& connection, const std::string& name) {
  return ControlJob<v1::CancelJobRequest>(connection, &v1::RenderService::Stub::CancelJob, name);
}

absl::StatusOr<v1::Job> PauseJob(Connection& connection, const std::string& name) {
  return ControlJob<v1::PauseJobRequest>(connection, &v1::RenderService::Stub::PauseJob, name);
}

absl::StatusOr<v1::Job> ResumeJob(Connection& connection, const std::string& name) {
  return ControlJob<v1::ResumeJobRequest>(connection, &v1::RenderService::Stub::ResumeJob, name);
}

absl::StatusOr<v1::Job> ShareJob(Connection& connection, const std::string& name, const std::string& grantee,
                                 v1::Share::Access access) {
  v1::ShareJobRequest request;
  request.set_name(name);
  request.mutable_share()->set_grantee(grantee);
  request.mutable_share()->set_access(access);
  return connection.Ask(connection.render(), &v1::RenderService::Stub::ShareJob, request);
}

absl::StatusOr<v1::Job> UnshareJob(Connection& connection, const std::string& name, const std::string& grantee) {
  v1::UnshareJobRequest request;
  request.set_name(name);
  request.set_grantee(grantee);
  return connection.Ask(connection.render(), &v1::RenderService::Stub::UnshareJob, request);
}

absl::Status DeleteJob(Connection& connection, const std::string& name) {
  v1::DeleteJobRequest request;
  request.set_name(name);
  v1::DeleteJobResponse response;
  return connection.Call(connection.render(), &v1::RenderService::Stub::DeleteJob, request, response);
}

absl::StatusOr<v1::RenderResult> FetchResult(Connection& connection, const std::string& name) {
  v1::GetResultRequest request;
  request.set_name(name);
  MessageStream<v1::GetResultResponse> stream(
      connection, [&](grpc::ClientContext* context, grpc::CompletionQueue* queue) {
        return connection.render().PrepareAsyncGetResult(context, request, queue);
      });
  std::string bytes;
  double total = 0;
  v1::GetResultResponse chunk;
  while (stream.Next(chunk, kSilence)) {
    bytes += chunk.data();
    total = chunk.total_bytes();
  }
  const grpc::Status status = stream.Finish();
  if (!status.ok()) return connection.Explain(status);
  v1::RenderResult result;
  if (static_cast<double>(bytes.size()) != total || !result.ParseFromString(bytes))
    return JobError("the server sent a broken result: " + std::to_string(bytes.size()) + " bytes");
  const std::string defect = FindResultDefect(result);
  if (!defect.empty()) return JobError("the server sent a broken result: " + defect);
  return result;
}

absl::Status CheckSuccess(const v1::Job& job) {
  switch (job.state()) {
    case v1::Job::SUCCEEDED:
      return absl::OkStatus();
    case v1::Job::CANCELLED:
      return JobError(job.name() + " was cancelled");
    default: {
      const absl::Status reason = ErrorFromRpc(job.error());
      return JobError(job.name() + " failed: " + std::string(reason.message().data(), reason.message().size()));
    }
  }
}

}  // namespace flatlight
