// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_SCENE_SOURCE_H_
#define FLATLIGHT_SERVER_SERVICE_SCENE_SOURCE_H_

#include <functional>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "core/scene/diagnostic.h"
#include "core/scene/scene.h"
#include "flatlight/v1/render_service.pb.h"
#include "flatlight/v1/scene.pb.h"
#include "flatlight/v1/scene_service.pb.h"
#include "server/service/limits.h"
#include "server/service/policy.h"
#include "server/service/scene_cache.h"
#include "server/store/scene_store.h"

namespace flatlight {

// A scene by name: of the gallery, or uploaded.
struct NamedScene {
  v1::SceneInfo info;
  std::shared_ptr<const std::string> json;
};

// The {scene} of scenes/{scene}, of a name that has that form.
std::string SceneIdOf(const std::string& name);

// Whoever has it. INVALID_ARGUMENT if `name` is not scenes/{scene}, NOT_FOUND if there is none.
absl::StatusOr<NamedScene> FindScene(const std::string& name, SceneStore& scenes);
// Uploads that the caller may not see are NOT_FOUND, in the very words of those that are not there.
absl::StatusOr<NamedScene> FindSeenScene(const Caller& caller, const std::string& name, SceneStore& scenes);

// Asked before each phase that may take seconds: is the work still wanted? The error says why not.
using Proceed = std::function<absl::Status()>;

// What `caller` may take scenes from.
struct SceneShelf {
  const Caller& caller;
  SceneStore& uploads;
  SceneCache& built;
  const Limits& limits;
};

// The scene that a request names or carries, checked and ready. Null if it has mistakes: they are in `diagnostics`.
// What `proceed` answers, if it is an error; it is asked before reading, before building, and at the end.
absl::StatusOr<std::shared_ptr<const Scene>> LoadScene(const v1::SceneSource& source, const SceneShelf& shelf,
                                                       const Proceed& proceed, Diagnostics& diagnostics);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_SCENE_SOURCE_H_
