// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/peers/flatlight_scene.h"

#include <cstdio>
#include <cstdlib>
#include <string>

#include "core/scene/diagnostic.h"

namespace flatlight {

SceneDescription BlackSegments(const std::vector<SegmentDescription>& segments) {
  SceneDescription scene;
  scene.name = "peers";
  scene.materials = {{"black", LambertianDescription{{0}}}};
  for (const SegmentDescription& segment : segments)
    scene.curves.push_back({"segment " + std::to_string(scene.curves.size()), segment, "black", std::nullopt});
  return scene;
}

std::shared_ptr<const Scene> BuiltOrExit(const SceneDescription& description) {
  Diagnostics diagnostics;
  std::shared_ptr<const Scene> scene = BuildScene(description, diagnostics);
  if (!scene) {
    std::fprintf(stderr, "peers: %s: %s\n", diagnostics.kept()[0].path.c_str(), diagnostics.kept()[0].message.c_str());
    std::exit(1);
  }
  for (std::size_t i = 0; i < scene->elements().size(); ++i) {
    if (static_cast<std::size_t>(scene->elements()[i].curve) == i) continue;
    std::fprintf(stderr, "peers: element %zu of the scene is not segment %zu\n", i, i);
    std::exit(1);
  }
  return scene;
}

}  // namespace flatlight
