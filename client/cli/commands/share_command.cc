// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "client/cli/commands/commands.h"
#include "client/cli/commands/job_text.h"
#include "client/cli/commands/session.h"
#include "client/cli/formats/json_text.h"
#include "client/cli/jobs/job_calls.h"
#include "client/cli/jobs/job_name.h"
#include "client/cli/scenes/scene_list.h"

namespace flatlight {
namespace {

// Does `change` for each grantee, and prints the job or the scene as the last one leaves it.
template <class Change>
CommandResult ChangeEach(const CommandLine& line, Connection& connection, const std::string& name,
                         const Change& change) {
  decltype(change(connection, name, name)) shared;
  for (const std::string& grantee : line.grantees) {
    shared = change(connection, name, grantee);
    if (!shared.ok()) return shared.status();
  }
  if (line.quiet && !line.json) return ExitCode::kDone;
  return Answer(line.json ? ToJson(*shared) : shared->name() + " shared with " + SharesText(shared->shares()) + '\n');
}

template <class ChangeJob, class ChangeScene>
CommandResult ChangeShares(const CommandLine& line, Interruption& interruption, const ChangeJob& change_job,
                           const ChangeScene& change_scene) {
  const auto session = Session::Open(line, Session::WithoutServer::kRefuse, interruption);
  if (!session.ok()) return session.status();
  Connection& connection = (*session)->connection();
  const bool scene = line.job.starts_with("scenes/");
  const auto name = scene ? ResolveUpload(connection, line.job) : ResolveJobName(connection, line.job);
  if (!name.ok()) return name.status();
  return scene ? ChangeEach(line, connection, *name, change_scene) : ChangeEach(line, connection, *name, change_job);
}

}  // namespace

CommandResult Share(const CommandLine& line, Interruption& interruption) {
  const auto access = line.control ? v1::Share::CONTROL : v1::Share::READ;
  return ChangeShares(
      line, interruption,
      [access](Connection& connection, const std::string& job, const std::string& grantee) {
        return ShareJob(connection, job, grantee, access);
      },
      [access](Connection& connection, const std::string& scene, const std::string& grantee) {
        return ShareScene(connection, scene, grantee, access);
      });
}

CommandResult Unshare(const CommandLine& line, Interruption& interruption) {
  return ChangeShares(line, interruption, UnshareJob, UnshareScene);
}

}  // namespace flatlight
