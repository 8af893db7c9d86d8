// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/commands/plan_text.h"
#include "client/cli/commands/session.h"
#include "client/cli/formats/json_text.h"
#include "client/cli/outputs/outputs.h"
#include "client/cli/scenes/scene_list.h"
#include "client/cli/scenes/scene_upload.h"
#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

std::string ShortName(const v1::SceneInfo& scene) {
  const std::string id = scene.name().substr(scene.name().find('/') + 1);
  return scene.gallery() ? "gallery:" + id : id;
}

std::string OwnersText(const v1::SceneInfo& scene) {
  std::string text;
  for (const std::string& owner : scene.owners()) text += (text.empty() ? "" : ", ") + owner;
  return Printable(text);
}

// With the owners of what is shared: else they are nobody but the caller, or what a grader asks for in another form.
std::string SceneListText(const v1::ListScenesResponse& list, WhoseScenes whose) {
  if (list.scenes().empty()) {
    return whose == WhoseScenes::kShared ? "no scenes are shared with you\n" : "you have uploaded no scenes\n";
  }
  std::vector<std::vector<std::string>> rows;
  for (const v1::SceneInfo& scene : list.scenes()) {
    rows.push_back({ShortName(scene), Printable(scene.gallery() ? scene.description() : scene.title()),
                    scene.gallery() ? "" : FormatBytes(scene.bytes())});
    if (whose == WhoseScenes::kShared) rows.back().push_back(OwnersText(scene));
  }
  return FormatTable(rows);
}

// `scenes NAME --delete`
CommandResult DeleteUpload(Connection& connection, const CommandLine& line) {
  const auto name = ResolveUpload(connection, line.scene);
  if (!name.ok()) return name.status();
  if (absl::Status deleted = DeleteScene(connection, *name); !deleted.ok()) return deleted;
  return Answer(*name + " deleted\n");
}

// `scenes NAME`: the scene itself, as a file to start from.
CommandResult PrintScene(Connection& connection, const std::string& text) {
  constexpr std::string_view kGallery = "gallery:";
  const std::string id = text.starts_with(kGallery)    ? text.substr(kGallery.size())
                         : text.starts_with("scenes/") ? text.substr(text.find('/') + 1)
                                                       : text;
  v1::GetSceneRequest request;
  request.set_name("scenes/" + id);
  v1::GetSceneResponse response;
  const absl::Status status =
      connection.Call(connection.scenes(), &v1::SceneService::Stub::GetScene, request, response);
  if (status.code() == absl::StatusCode::kNotFound || status.code() == absl::StatusCode::kInvalidArgument)
    return UsageError("there is no scene '" + text + "'; `flatlight scenes` lists them");
  if (!status.ok()) return status;
  return Answer(ToJson(response.scene()));
}

std::string TraitsText(const SceneArgument& scene, const v1::ValidateSceneResponse& response) {
  const v1::SceneTraits& traits = response.traits();
  return FormatTable({{scene.label, "is a good scene"},
                      {"curves", FormatExactly(traits.curves()) + " (" + Plural(traits.elements(), "piece") + ", " +
                                     Plural(traits.emitters(), "emitter") + ")"},
                      {"probes", Plural(traits.probe_points(), "point") +
                                     (traits.pixels() > 0 ? ", " + Plural(traits.pixels(), "pixel") : "")},
                      {"spectra", traits.grey() ? "grey" : "coloured"},
                      {"largest reflectance", FormatExactly(traits.max_reflectance())},
                      {"world", response.world_hash()},
                      {"probes' hash", response.probe_hash()}});
}

// The scene of the command line, at a server.
struct OpenedScene {
  SceneArgument scene;
  std::unique_ptr<Session> session;
  v1::SceneSource source;
};

absl::StatusOr<OpenedScene> OpenScene(const CommandLine& line, Interruption& interruption) {
  auto scene = ParseSceneArgument(line.scene);
  if (!scene.ok()) return scene.status();
  if (absl::Status readable = CheckSceneFile(*scene); !readable.ok()) return readable;
  auto session = Session::Open(line, Session::WithoutServer::kStartOne, interruption);
  if (!session.ok()) return session.status();
  auto source = ProvideScene((*session)->connection(), *scene, line.probes);
  if (!source.ok()) return (*session)->Explain(source.status());
  return OpenedScene{*std::move(scene), *std::move(session), *std::move(source)};
}

}  // namespace

CommandResult Scenes(const CommandLine& line, Interruption& interruption) {
  const auto session = Session::Open(line, Session::WithoutServer::kStartOne, interruption);
  if (!session.ok()) return session.status();
  if (line.remove) return DeleteUpload((*session)->connection(), line);
  if (!line.scene.empty()) return PrintScene((*session)->connection(), line.scene);
  const WhoseScenes whose = line.shared ? WhoseScenes::kShared : line.mine ? WhoseScenes::kOwn : WhoseScenes::kAll;
  const auto list = ListScenes((*session)->connection(), whose);
  if (!list.ok()) return (*session)->Explain(list.status());
  return Answer(line.json ? ToJson(*list) : SceneListText(*list, whose));
}

CommandResult Explain(const CommandLine& line, Interruption& interruption) {
  const auto opened = OpenScene(line, interruption);
  if (!opened.ok()) return opened.status();
  const auto& [scene, session, source] = *opened;
  Connection& connection = session->connection();
  v1::ExplainJobRequest request;
  *request.mutable_scene() = source;
  *request.mutable_settings() = line.settings;
  v1::ExplainJobResponse response;
  const absl::Status status =
      connection.Call(connection.render(), &v1::RenderService::Stub::ExplainJob, request, response);
  if (!status.ok()) return ExplainSceneError(connection, scene, source, session->Explain(status));
  return Answer(line.json ? ToJson(response.plan()) : PlanText(response.plan()));
}

CommandResult Validate(const CommandLine& line, Interruption& interruption) {
  const auto opened = OpenScene(line, interruption);
  if (!opened.ok()) return opened.status();
  const auto& [scene, session, source] = *opened;
  const auto response = ValidateScene(session->connection(), source);
  if (!response.ok())
    return ExplainSceneError(session->connection(), scene, source, session->Explain(response.status()));
  if (line.json)
    if (absl::Status printed = PrintBytes(ToJson(*response)); !printed.ok()) return printed;
  if (!response->diagnostics().empty()) return UsageError(DiagnosticLines(scene, *response));
  return line.json || line.quiet ? ExitCode::kDone : Answer(TraitsText(scene, *response));
}

}  // namespace flatlight
