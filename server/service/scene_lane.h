// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_SCENE_LANE_H_
#define FLATLIGHT_SERVER_SERVICE_SCENE_LANE_H_

#include "server/service/call.h"
#include "server/service/scene_source.h"

namespace flatlight {

// Which lane reads a scene by name. One that the caller may not see is as one that is not there.
inline Lane LaneOf(const Caller& caller, const std::string& scene_name, SceneStore& scenes) {
  const auto scene = FindSeenScene(caller, scene_name, scenes);
  return scene.ok() && scene->json->size() > kMaxQuickBytes ? Lane::kSlow : Lane::kQuick;
}

// Which lane reads a scene that a small request names or carries.
inline Lane LaneOf(const Caller& caller, const v1::SceneSource& source, SceneStore& scenes) {
  return source.has_name() ? LaneOf(caller, source.name(), scenes) : Lane::kQuick;
}

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_SCENE_LANE_H_
