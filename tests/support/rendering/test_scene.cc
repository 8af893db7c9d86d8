// SPDX-License-Identifier: Apache-2.0
#include "tests/support/rendering/test_scene.h"

#include <cstdio>
#include <cstdlib>

namespace flatlight::testing {

SceneDescription FloorAndLampDescription(const std::vector<std::uint32_t>& counts) {
  SceneDescription scene;
  scene.name = "floor and lamp";
  scene.materials.push_back({"white", LambertianDescription{{0.5}}});
  CurveDescription floor{"floor", SegmentDescription{{-1, 0}, {1, 0}}, "white", {}};
  CurveDescription lamp{"lamp", SegmentDescription{{1, 1}, {-1, 1}}, "white", EmissionDescription{{1}, false}};
  scene.curves = {floor, lamp};
  for (const std::uint32_t count : counts) {
    ProbeDescription probe;
    probe.name = "probe" + std::to_string(scene.probes.size());
    probe.curve = "floor";
    probe.count = count;
    scene.probes.push_back(probe);
  }
  return scene;
}

std::shared_ptr<const Scene> FloorAndLamp(const std::vector<std::uint32_t>& counts) {
  Diagnostics diagnostics;
  auto scene = BuildScene(FloorAndLampDescription(counts), diagnostics);
  for (const Diagnostic& diagnostic : diagnostics.kept()) {
    std::fprintf(stderr, "%s: %s\n", diagnostic.path.c_str(), diagnostic.message.c_str());
  }
  if (scene == nullptr) std::abort();
  return scene;
}

}  // namespace flatlight::testing
