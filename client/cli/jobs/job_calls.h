// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_JOBS_JOB_CALLS_H_
#define FLATLIGHT_CLIENT_CLI_JOBS_JOB_CALLS_H_

#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/connection/connection.h"

namespace flatlight {

struct CreateJobOptions {
  v1::JobClass job_class = v1::INTERACTIVE;
  std::optional<v1::KnownRecords> records = std::nullopt;
  bool anew = false;         // Does its own work, also if that of an equal job could be shared.
  std::string webhook = {};  // A URL that the server tells of the job's end; empty: none.
};

// Repeats itself if the server was lost on the way; a request id makes sure that there is one job.
absl::StatusOr<v1::Job> CreateJob(Connection& connection, const v1::SceneSource& scene, const v1::Settings& settings,
                                  const CreateJobOptions& options = {});

absl::StatusOr<v1::Job> GetJob(Connection& connection, const std::string& name);

// These work also after a signal.
absl::StatusOr<v1::Job> CancelJob(Connection& connection, const std::string& name);
absl::StatusOr<v1::Job> PauseJob(Connection& connection, const std::string& name);
absl::StatusOr<v1::Job> ResumeJob(Connection& connection, const std::string& name);

// Lets `grantee` ("user:ada", "group:lab-1", "course") use the job, or no longer. The job that is returned has its
// shares.
absl::StatusOr<v1::Job> ShareJob(Connection& connection, const std::string& name, const std::string& grantee,
                                 v1::Share::Access access);
absl::StatusOr<v1::Job> UnshareJob(Connection& connection, const std::string& name, const std::string& grantee);

// Of an ended job: the server need not keep it.
absl::Status DeleteJob(Connection& connection, const std::string& name);

// The result of an ended job, checked to be whole.
absl::StatusOr<v1::RenderResult> FetchResult(Connection& connection, const std::string& name);

// OK if the job succeeded, else why not: ends with ExitCode::kJobFailed.
absl::Status CheckSuccess(const v1::Job& job);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_JOBS_JOB_CALLS_H_
