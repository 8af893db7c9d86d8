// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "client/cli/commands/commands.h"
#include "client/cli/commands/job_text.h"
#include "client/cli/commands/session.h"
#include "client/cli/formats/json_text.h"
#include "client/cli/jobs/job_calls.h"
#include "client/cli/jobs/job_name.h"

namespace flatlight {
namespace {

// Does `change` for each grantee, and prints the job as the last one leaves it.
template <class Change>
CommandResult ChangeShares(const CommandLine& line, Interruption& interruption, const Change& change) {
  const auto session = Session::Open(line, Session::WithoutServer::kRefuse, interruption);
  if (!session.ok()) return session.status();
  Connection& connection = (*session)->connection();
  const auto name = ResolveJobName(connection, line.job);
  if (!name.ok()) return name.status();
  absl::StatusOr<v1::Job> job;
  for (const std::string& grantee : line.grantees) {
    job = change(connection, *name, grantee);
    if (!job.ok()) return job.status();
  }
  if (line.quiet && !line.json) return ExitCode::kDone;
  const std::string text = line.json ? ToJson(*job) : job->name() + " shared with " + SharesText(job->shares()) + '\n';
  return Answer(text);
}

}  // namespace

CommandResult Share(const CommandLine& line, Interruption& interruption) {
  const auto access = line.control ? v1::Share::CONTROL : v1::Share::READ;
  return ChangeShares(line, interruption,
                      [access](Connection& connection, const std::string& job, const std::string& grantee) {
                        return ShareJob(connection, job, grantee, access);
                      });
}

CommandResult Unshare(const CommandLine& line, Interruption& interruption) {
  return ChangeShares(line, interruption, UnshareJob);
}

}  // namespace flatlight
