// SPDX-License-Identifier: Apache-2.0
// What the figures that are results of several jobs have in common.
#ifndef FLATLIGHT_CLIENT_CLI_COMMANDS_FIGURE_DRAWING_H_
#define FLATLIGHT_CLIENT_CLI_COMMANDS_FIGURE_DRAWING_H_

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/commands/commands.h"
#include "client/cli/commands/console.h"
#include "client/cli/commands/session.h"
#include "client/cli/outputs/outputs.h"
#include "flatlight/v1/render_service.pb.h"

namespace flatlight {

// What a figure is drawn with.
struct FigureDrawing {
  const CommandLine& line;
  const std::vector<Output>& outputs;
  Session& session;
  Console& console;
  Interruption& interruption;

  // A scene rendered, without all probes but the first.
  absl::StatusOr<v1::RenderResult> RenderFirstProbe(const v1::SceneSource& source, const v1::Settings& settings) const;
  // Says `text` and writes the result.
  CommandResult Deliver(const std::string& text, const v1::RenderResult& result) const;
};

// Checks the outputs and opens a session before it draws.
CommandResult OpenAndDraw(const CommandLine& line, Interruption& interruption,
                          const std::function<CommandResult(const FigureDrawing&)>& draw);

v1::SceneSource GallerySource(const std::string& name);

// The first probe of a scene rendered: for figures that deliver no result.
absl::StatusOr<v1::RenderResult> RenderFirstProbe(Session& session, const v1::SceneSource& source,
                                                  const v1::Settings& settings);

// Makes a result one of several jobs: what speaks of one of them alone is left out.
void MakeCommon(const std::string& name, v1::RenderResult& result);

// A relative error for people; "-" if there is none.
std::string Share(const std::optional<double>& relative);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMMANDS_FIGURE_DRAWING_H_
