// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_SCENE_OUTLINE_H_
#define FLATLIGHT_SERVER_STORE_SCENE_OUTLINE_H_

#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace flatlight {

// What results and watchers need to know of a scene. Jobs keep this when they have ended, not the scene.
struct SceneOutline {
  SceneOutline() = default;
  explicit SceneOutline(const Scene& scene)
      : name(scene.name()),
        channels(scene.channels()),
        frame(scene.frame()),
        probes(scene.probes()),
        traits(scene.traits()),
        world_hash(scene.world_hash()),
        probe_hash(scene.probe_hash()) {}

  Point2 ToWorld(Point2 p) const { return {frame.origin.x + frame.scale * p.x, frame.origin.y + frame.scale * p.y}; }

  std::string name;
  int channels = 1;
  Frame frame;
  std::vector<Probe> probes;
  SceneTraits traits;
  std::string world_hash;
  std::string probe_hash;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_SCENE_OUTLINE_H_
