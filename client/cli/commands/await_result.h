// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_COMMANDS_AWAIT_RESULT_H_
#define FLATLIGHT_CLIENT_CLI_COMMANDS_AWAIT_RESULT_H_

#include "absl/status/statusor.h"
#include "client/cli/commands/console.h"
#include "client/cli/commands/session.h"
#include "flatlight/v1/render_service.pb.h"
#include "flatlight/v1/result.pb.h"

namespace flatlight {

// Shows a job's progress until it ends, and fetches its result. Ctrl-C, or a console that finds no reader any more,
// cancels the job; with `cancel_on_disconnect` so does a connection that breaks.
absl::StatusOr<v1::RenderResult> AwaitResult(Session& session, const v1::Job& job, bool cancel_on_disconnect,
                                             Console& console);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMMANDS_AWAIT_RESULT_H_
