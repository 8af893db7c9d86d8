// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_RENDER_CALLS_H_
#define FLATLIGHT_SERVER_SERVICE_RENDER_CALLS_H_

#include "absl/status/statusor.h"
#include "flatlight/v1/render_service.pb.h"
#include "grpcpp/support/byte_buffer.h"
#include "server/service/backend.h"
#include "server/service/scene_source.h"
#include "server/store/job_archive.h"

namespace flatlight {

// The unary calls of RenderService as plain functions. Those that may take seconds end early when `proceed` says so.
absl::StatusOr<v1::Job> CreateJob(Backend& backend, const Caller& caller, const v1::CreateJobRequest& request,
                                  const Proceed& proceed);
// A job of a process before, made again from what was submitted, with its last checkpoint.
absl::StatusOr<JobRun::Restored> RestoreJob(Backend& backend, JobArchive& archive, const JobSpec& accepted);
// A serialised v1::Job.
absl::StatusOr<grpc::ByteBuffer> GetJob(Backend& backend, const Caller& caller, const v1::GetJobRequest& request);
absl::StatusOr<v1::ListJobsResponse> ListJobs(Backend& backend, const Caller& caller,
                                              const v1::ListJobsRequest& request);
absl::StatusOr<v1::Job> CancelJob(Backend& backend, const Caller& caller, const v1::CancelJobRequest& request);
absl::StatusOr<v1::Job> PauseJob(Backend& backend, const Caller& caller, const v1::PauseJobRequest& request);
absl::StatusOr<v1::Job> ResumeJob(Backend& backend, const Caller& caller, const v1::ResumeJobRequest& request);
absl::StatusOr<v1::DeleteJobResponse> DeleteJob(Backend& backend, const Caller& caller,
                                                const v1::DeleteJobRequest& request);
absl::StatusOr<v1::Job> ShareJob(Backend& backend, const Caller& caller, const v1::ShareJobRequest& request);
absl::StatusOr<v1::Job> UnshareJob(Backend& backend, const Caller& caller, const v1::UnshareJobRequest& request);
absl::StatusOr<v1::ExplainJobResponse> ExplainJob(Backend& backend, const Caller& caller,
                                                  const v1::ExplainJobRequest& request, const Proceed& proceed);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_RENDER_CALLS_H_
