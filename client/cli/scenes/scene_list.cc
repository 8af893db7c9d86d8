// SPDX-License-Identifier: Apache-2.0
#include "client/cli/scenes/scene_list.h"

#include <algorithm>
#include <set>

#include "client/cli/scenes/scene_file.h"
#include "client/cli/status/exit_code.h"

namespace flatlight {
namespace {

constexpr std::string_view kPrefix = "scenes/";

bool IsHashBeginning(std::string_view text) {
  return !text.empty() && text.size() <= kHashDigits &&
         std::all_of(text.begin(), text.end(), [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

}  // namespace

absl::StatusOr<v1::ListScenesResponse> ListScenes(Connection& connection, WhoseScenes whose) {
  v1::ListScenesResponse all;
  v1::ListScenesRequest request;
  request.set_page_size(1000);
  request.set_own(whose == WhoseScenes::kOwn);
  request.set_shared(whose == WhoseScenes::kShared);
  do {
    v1::ListScenesResponse response;
    const absl::Status status =
        connection.Call(connection.scenes(), &v1::SceneService::Stub::ListScenes, request, response);
    if (!status.ok()) return status;
    all.mutable_scenes()->MergeFrom(response.scenes());
    request.set_page_token(response.next_page_token());
  } while (!request.page_token().empty());
  return all;
}

absl::StatusOr<std::string> ResolveUpload(Connection& connection, const std::string& text) {
  const std::string beginning = text.starts_with(kPrefix) ? text.substr(kPrefix.size()) : text;
  if (!IsHashBeginning(beginning)) {
    return UsageError("'" + text + "' is no uploaded scene; must be scenes/HASH, or the beginning of that");
  }
  if (beginning.size() == kHashDigits) return std::string(kPrefix) + beginning;
  std::set<std::string> matches;
  for (const WhoseScenes whose : {WhoseScenes::kAll, WhoseScenes::kShared}) {
    const auto scenes = ListScenes(connection, whose);
    if (!scenes.ok()) return scenes.status();
    for (const v1::SceneInfo& scene : scenes->scenes()) {
      if (!scene.gallery() && scene.name().substr(kPrefix.size()).starts_with(beginning)) matches.insert(scene.name());
    }
  }
  if (matches.size() == 1) return *matches.begin();
  return UsageError((matches.empty() ? "no uploaded scene begins" : std::to_string(matches.size()) + " scenes begin") +
                    " with '" + beginning + "'; `flatlight scenes` lists yours, with --shared those of others");
}

absl::StatusOr<v1::SceneInfo> ShareScene(Connection& connection, const std::string& name, const std::string& grantee,
                                         v1::Share::Access access) {
  v1::ShareSceneRequest request;
  request.set_name(name);
  request.mutable_share()->set_grantee(grantee);
  request.mutable_share()->set_access(access);
  return connection.Ask(connection.scenes(), &v1::SceneService::Stub::ShareScene, request);
}

absl::StatusOr<v1::SceneInfo> UnshareScene(Connection& connection, const std::string& name,
                                           const std::string& grantee) {
  v1::UnshareSceneRequest request;
  request.set_name(name);
  request.set_grantee(grantee);
  return connection.Ask(connection.scenes(), &v1::SceneService::Stub::UnshareScene, request);
}

absl::Status DeleteScene(Connection& connection, const std::string& name) {
  v1::DeleteSceneRequest request;
  request.set_name(name);
  v1::DeleteSceneResponse response;
  return connection.Call(connection.scenes(), &v1::SceneService::Stub::DeleteScene, request, response);
}

}  // namespace flatlight
