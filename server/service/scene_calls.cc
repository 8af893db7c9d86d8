// SPDX-License-Identifier: Apache-2.0
#include "server/service/scene_calls.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "server/convert/result_convert.h"
#include "server/convert/scene_reader.h"
#include "server/gallery/gallery.h"
#include "server/service/job_convert.h"
#include "server/service/page.h"
#include "server/service/policy.h"
#include "server/service/quota_calls.h"
#include "server/service/scene_source.h"
#include "server/service/status_convert.h"
#include "server/store/error.h"

namespace flatlight {
namespace {

// Positions of a list of scenes: the gallery's are 0, 1, ...; uploads follow, each at this plus where its page begins.
constexpr std::uint64_t kUploads = 1'000'000;

// Returns where the next page begins; nothing: no more of the gallery follows.
std::optional<std::uint64_t> AddGallery(std::uint64_t position, std::size_t size, v1::ListScenesResponse& response) {
  const auto& gallery = Gallery();
  for (; position < gallery.size() && static_cast<std::size_t>(response.scenes_size()) < size; ++position) {
    const GalleryScene& scene = gallery[position];
    v1::SceneInfo& info = *response.add_scenes();
    info.set_name("scenes/" + scene.name);
    info.set_title(scene.title);
    info.set_description(scene.description);
    info.set_gallery(true);
    info.set_bytes(static_cast<double>(scene.json.size()));
  }
  return position < gallery.size() ? std::optional(position) : std::nullopt;
}

// Who has an upload, as far as the caller may know.
void AddOwners(const Caller& caller, const std::string& sha256, SceneStore& scenes, v1::SceneInfo& info) {
  if (caller.role >= Role::kGrader) {
    for (const std::string& owner : scenes.OwnersOf(sha256)) info.add_owners(owner);
    return;
  }
  if (scenes.Owns(caller.name, sha256)) info.add_owners(caller.name);
  for (const auto& [owner, access] : scenes.SharedBy(sha256, Grantee::Of(caller.name, caller.groups))) {
    if (owner != caller.name) info.add_owners(owner);
  }
}

void AddUploads(const Caller& caller, const ScenePage& uploads, SceneStore& scenes, v1::ListScenesResponse& response) {
  for (const StoredScene& scene : uploads.scenes) {
    v1::SceneInfo& info = *response.add_scenes();
    info.set_name("scenes/" + scene.sha256);
    info.set_title(scene.title);
    info.set_bytes(static_cast<double>(scene.bytes->size()));
    AddOwners(caller, scene.sha256, scenes, info);
  }
}

// With its owners, and the caller's own shares.
void AddSharing(const Caller& caller, SceneStore& scenes, v1::SceneInfo& info) {
  AddOwners(caller, SceneIdOf(info.name()), scenes, info);
  for (const Grant& grant : scenes.GrantsOf(caller.name, SceneIdOf(info.name())))
    *info.add_shares() = GrantToProto(grant);
}

// Does `action(hash)` for an upload of the caller's own.
template <class Action>
absl::StatusOr<v1::SceneInfo> ChangeShares(Backend& backend, const Caller& caller, const std::string& name,
                                           const Action& action) {
  auto scene = FindSeenScene(caller, name, backend.scenes);
  if (!scene.ok()) return scene.status();
  if (scene->info.gallery()) {
    return MakeError(absl::StatusCode::kFailedPrecondition, "GALLERY_SCENE",
                     name + " belongs to the gallery, which everybody has");
  }
  const std::string sha256 = SceneIdOf(name);
  if (!backend.scenes.Owns(caller.name, sha256)) {
    return MakeError(absl::StatusCode::kPermissionDenied, "NOT_YOUR_SCENE",
                     name + " is not yours: only who has uploaded it shares it");
  }
  if (absl::Status changed = action(sha256); !changed.ok()) return changed;
  AddSharing(caller, backend.scenes, scene->info);
  return std::move(scene->info);
}

}  // namespace

absl::StatusOr<v1::UploadSceneResponse> UploadScene(Backend& backend, const Caller& caller,
                                                    const v1::UploadSceneRequest& request) {
  std::optional<SceneRoom> room;
  if (const auto& allowed = backend.guard.QuotasOf(caller).storage_bytes) {
    room = SceneRoom{*allowed, backend.jobs.StoredBytesOf(caller.name)};
  }
  const auto received = backend.scenes.Upload(caller.name, request.sha256(), request.total_bytes(), request.offset(),
                                              request.data(), room);
  if (!received.ok()) return received.status();
  v1::UploadSceneResponse response;
  response.set_name("scenes/" + request.sha256());
  response.set_received_bytes(*received);
  return response;
}

absl::StatusOr<v1::GetSceneResponse> GetScene(Backend& backend, const Caller& caller,
                                              const v1::GetSceneRequest& request) {
  auto scene = FindSeenScene(caller, request.name(), backend.scenes);
  if (!scene.ok()) return scene.status();
  v1::GetSceneResponse response;
  Diagnostics diagnostics;
  if (!ReadSceneJson(*scene->json, *response.mutable_scene(), diagnostics)) {
    return MakeDiagnosticsError("BAD_SCENE", "the scene", diagnostics);
  }
  *response.mutable_info() = std::move(scene->info);
  if (response.info().gallery()) return response;
  response.mutable_info()->set_title(response.scene().name());
  AddSharing(caller, backend.scenes, *response.mutable_info());
  return response;
}

absl::StatusOr<v1::ListScenesResponse> ListScenes(Backend& backend, const Caller& caller,
                                                  const v1::ListScenesRequest& request) {
  if (request.shared() && request.own()) return MakeFieldError("own", "true; allowed: false, with shared");
  std::optional<std::string> owner;
  if (caller.role < Role::kGrader || request.own()) owner = caller.name;
  const bool gallery = !request.shared() && !request.own();
  const std::string list = (request.shared() ? "scenes shared with "
                            : request.own()  ? "own scenes of "
                            : owner          ? "scenes of "
                                             : "all scenes, for ") +
                           caller.name;
  const auto page = ParsePage(backend.page_tokens, list, request.page_size(), request.page_token());
  if (!page.ok()) return page.status();
  const std::uint64_t position = page->position.value_or(gallery ? 0 : kUploads);
  v1::ListScenesResponse response;
  const auto go_on_at = [&](std::uint64_t next) {
    response.set_next_page_token(backend.page_tokens.Seal(list, next));
    return response;
  };
  if (position < kUploads) {
    if (const auto next = AddGallery(position, page->size, response)) return go_on_at(*next);
  }
  std::optional<std::uint64_t> before;
  if (position > kUploads) before = position - kUploads;
  const std::size_t room = page->size - static_cast<std::size_t>(response.scenes_size());
  const std::size_t limit = std::max<std::size_t>(room, 1);
  const ScenePage uploads =
      request.shared() ? backend.scenes.ListShared(Grantee::Of(caller.name, caller.groups), caller.name, before, limit)
                       : backend.scenes.List(owner, before, limit);
  if (room == 0) return uploads.scenes.empty() ? response : go_on_at(kUploads);
  AddUploads(caller, uploads, backend.scenes, response);
  return uploads.next_before ? go_on_at(kUploads + *uploads.next_before) : response;
}

absl::StatusOr<v1::DeleteSceneResponse> DeleteScene(Backend& backend, const Caller& caller,
                                                    const v1::DeleteSceneRequest& request) {
  const auto scene = FindSeenScene(caller, request.name(), backend.scenes);
  if (!scene.ok()) return scene.status();
  if (scene->info.gallery()) {
    return MakeError(absl::StatusCode::kFailedPrecondition, "GALLERY_SCENE",
                     request.name() + " belongs to the gallery and stays");
  }
  const std::string sha256 = SceneIdOf(request.name());
  if (absl::Status deleted = DeleteSeenScene(caller, sha256, backend.scenes); !deleted.ok()) return deleted;
  if (!backend.scenes.Get(sha256).ok()) backend.built_scenes.Drop(sha256);
  return v1::DeleteSceneResponse();
}

absl::StatusOr<v1::SceneInfo> ShareScene(Backend& backend, const Caller& caller, const v1::ShareSceneRequest& request) {
  const auto grant = GrantFromProto(request.share());
  if (!grant.ok()) return grant.status();
  return ChangeShares(backend, caller, request.name(),
                      [&](const std::string& sha256) { return backend.scenes.Share(caller.name, sha256, *grant); });
}

absl::StatusOr<v1::SceneInfo> UnshareScene(Backend& backend, const Caller& caller,
                                           const v1::UnshareSceneRequest& request) {
  const auto grantee = GranteeFromProto("grantee", request.grantee());
  if (!grantee.ok()) return grantee.status();
  return ChangeShares(backend, caller, request.name(),
                      [&](const std::string& sha256) { return backend.scenes.Unshare(caller.name, sha256, *grantee); });
}

absl::StatusOr<v1::ValidateSceneResponse> ValidateScene(Backend& backend, const Caller& caller,
                                                        const v1::ValidateSceneRequest& request,
                                                        const Proceed& proceed) {
  Diagnostics diagnostics;
  const auto scene =
      LoadScene(request.scene(), {caller, backend.scenes, backend.built_scenes, backend.limits}, proceed, diagnostics);
  if (!scene.ok()) return scene.status();
  v1::ValidateSceneResponse response;
  for (const Diagnostic& diagnostic : diagnostics.kept()) {
    v1::Diagnostic& out = *response.add_diagnostics();
    out.set_path(diagnostic.path);
    out.set_message(diagnostic.message);
  }
  response.set_more_diagnostics(static_cast<std::uint32_t>(diagnostics.count() - diagnostics.kept().size()));
  if (*scene != nullptr) {
    response.set_world_hash((*scene)->world_hash());
    response.set_probe_hash((*scene)->probe_hash());
    *response.mutable_traits() = TraitsToProto((*scene)->traits());
  }
  return response;
}

}  // namespace flatlight
