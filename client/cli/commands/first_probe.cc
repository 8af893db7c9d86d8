// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/first_probe.h"

#include "client/cli/commands/await_result.h"
#include "client/cli/jobs/job_calls.h"

namespace flatlight {

absl::StatusOr<v1::RenderResult> RenderFirstProbe(Session& session, const v1::SceneSource& source,
                                                  const v1::Settings& settings, Console& console) {
  const auto job = CreateJob(session.connection(), source, settings);
  if (!job.ok()) return job.status();
  auto result = AwaitResult(session, *job, console);
  if (!result.ok()) return result.status();
  result->mutable_probes()->DeleteSubrange(1, result->probes_size() - 1);
  return result;
}

}  // namespace flatlight
