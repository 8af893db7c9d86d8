// SPDX-License-Identifier: Apache-2.0
#include "server/service/policy.h"

#include <unordered_map>

#include "server/store/error.h"

namespace flatlight {
namespace {

absl::Status Denied(const std::string& reason, const std::string& message) {
  return MakeError(absl::StatusCode::kPermissionDenied, reason, message);
}

}  // namespace

const std::vector<PolicyRow>& Policy() {
  static const std::vector<PolicyRow> kPolicy = {
      // Whose the job is decides the rest: JobAccess.
      {"CreateJobRequest", Role::kStudent},
      {"GetJobRequest", Role::kStudent},
      {"ListJobsRequest", Role::kStudent},
      {"WatchJobRequest", Role::kStudent},
      {"GetResultRequest", Role::kStudent},
      {"CancelJobRequest", Role::kStudent},
      {"PauseJobRequest", Role::kStudent},
      {"ResumeJobRequest", Role::kStudent},
      {"DeleteJobRequest", Role::kStudent},
      {"ShareJobRequest", Role::kStudent},
      {"UnshareJobRequest", Role::kStudent},
      {"ExplainJobRequest", Role::kStudent},
      {"CreateRoomRequest", Role::kInstructor},
      // Whose the room is decides the rest: ReviewCalls.
      {"GetRoomRequest", Role::kStudent},
      {"ListRoomsRequest", Role::kStudent},
      {"ShareRoomRequest", Role::kStudent},
      {"UnshareRoomRequest", Role::kStudent},
      {"LookAtRequest", Role::kStudent},
      {"AddNoteRequest", Role::kStudent},
      {"WatchRoomRequest", Role::kStudent},
      {"CloseRoomRequest", Role::kStudent},
      {"DeleteRoomRequest", Role::kStudent},
      // Who has uploaded the scene decides the rest: MaySeeScene, DeleteSeenScene.
      {"UploadSceneRequest", Role::kStudent},
      {"GetSceneRequest", Role::kStudent},
      {"ListScenesRequest", Role::kStudent},
      {"DeleteSceneRequest", Role::kStudent},
      {"ShareSceneRequest", Role::kStudent},  // Whoever has uploaded it.
      {"UnshareSceneRequest", Role::kStudent},
      {"ValidateSceneRequest", Role::kStudent},
      {"GetCapabilitiesRequest", Role::kStudent},
      {"GetWebhookSecretRequest", Role::kStudent},
      {"RotateWebhookSecretRequest", Role::kStudent},
      {"GetActivityRequest", Role::kStudent},  // Students see others only as numbers.
  };
  return kPolicy;
}

absl::Status CheckRole(const Caller& caller, std::string_view request) {
  static const auto kLeast = [] {
    std::unordered_map<std::string_view, Role> least;
    for (const PolicyRow& row : Policy()) least[row.request] = row.least;
    return least;
  }();
  const auto found = kLeast.find(request);
  if (found == kLeast.end()) return Denied("ROLE_TOO_LOW", "this call is open to nobody");
  const Role least = found->second;
  if (caller.role >= least) return absl::OkStatus();
  return Denied("ROLE_TOO_LOW", "this call is for the role " + std::string(RoleName(least)) + " and above; " +
                                    caller.name + " is a " + std::string(RoleName(caller.role)));
}

bool MaySeeScene(const Caller& caller, const std::string& sha256, SceneStore& scenes) {
  return caller.role >= Role::kGrader || scenes.Owns(caller.name, sha256) ||
         !scenes.SharedBy(sha256, Grantee::Of(caller.name, caller.groups)).empty();
}

absl::Status DeleteSeenScene(const Caller& caller, const std::string& sha256, SceneStore& scenes) {
  if (caller.role >= Role::kInstructor) return scenes.Delete(sha256);
  absl::Status disowned = scenes.Disown(caller.name, sha256);
  if (!absl::IsNotFound(disowned)) return disowned;
  bool controls = false;
  for (const auto& [owner, access] : scenes.SharedBy(sha256, Grantee::Of(caller.name, caller.groups))) {
    if (access < Access::kControl) continue;
    controls = true;
    absl::Status taken = scenes.Disown(owner, sha256);
    if (!taken.ok() && !absl::IsNotFound(taken)) return taken;  // Its owner may have deleted it meanwhile.
  }
  if (controls) return absl::OkStatus();
  if (!MaySeeScene(caller, sha256, scenes)) return disowned;
  return Denied("NOT_YOUR_SCENE", "scenes/" + sha256 + " is not yours: you may read it, but not delete it");
}

}  // namespace flatlight
