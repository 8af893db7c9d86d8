// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_COMMANDS_FIRST_PROBE_H_
#define FLATLIGHT_CLIENT_CLI_COMMANDS_FIRST_PROBE_H_

#include "absl/status/statusor.h"
#include "client/cli/commands/console.h"
#include "client/cli/commands/session.h"
#include "flatlight/v1/render_service.pb.h"

namespace flatlight {

// A scene rendered, without all probes but the first: for figures.
absl::StatusOr<v1::RenderResult> RenderFirstProbe(Session& session, const v1::SceneSource& source,
                                                  const v1::Settings& settings, Console& console);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMMANDS_FIRST_PROBE_H_
