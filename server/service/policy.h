// SPDX-License-Identifier: Apache-2.0
// Who may call what: the one table that every call is held against; and the rules about whose a scene is. (Of jobs:
// JobAccess.)
#ifndef FLATLIGHT_SERVER_SERVICE_POLICY_H_
#define FLATLIGHT_SERVER_SERVICE_POLICY_H_

#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "server/store/scene_store.h"
#include "server/store/user_store.h"

namespace flatlight {

struct Caller {
  std::string name;
  Role role = Role::kStudent;
  std::vector<std::string> groups = {};
  std::string token_sha256 = {};  // By which it is known; empty: kAnonymous, or the server's own.
};

// Each RPC has a request message of its own, by whose name it is found.
struct PolicyRow {
  std::string_view request;  // "CreateJobRequest", of flatlight.v1.
  Role least;                // Who has less is refused.
};
const std::vector<PolicyRow>& Policy();

// OK, or PERMISSION_DENIED with ROLE_TOO_LOW; also where the table has no row.
absl::Status CheckRole(const Caller& caller, std::string_view request);

// Of uploaded scenes: one's own uploads, those that are shared with one, and all of them for graders, instructors and
// admins. The hash alone opens nothing.
bool MaySeeScene(const Caller& caller, const std::string& sha256, SceneStore& scenes);
// Deletes an uploaded scene: one's own upload, else those that are shared with one with control; for an instructor or
// admin everybody's. One that is seen, and no more, is PERMISSION_DENIED with NOT_YOUR_SCENE.
absl::Status DeleteSeenScene(const Caller& caller, const std::string& sha256, SceneStore& scenes);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_POLICY_H_
