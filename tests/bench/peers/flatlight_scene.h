// SPDX-License-Identifier: Apache-2.0
// From segments to a scene of Flatlight's.
#ifndef FLATLIGHT_TESTS_BENCH_PEERS_FLATLIGHT_SCENE_H_
#define FLATLIGHT_TESTS_BENCH_PEERS_FLATLIGHT_SCENE_H_

#include <memory>
#include <vector>

#include "core/scene/description.h"
#include "core/scene/scene.h"

namespace flatlight {

// One curve a segment, in their order; black, without emission and without probes.
SceneDescription BlackSegments(const std::vector<SegmentDescription>& segments);

// Ends the program with a message if the scene cannot be built, or if its curves were cut to pieces or reordered.
std::shared_ptr<const Scene> BuiltOrExit(const SceneDescription& description);

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_BENCH_PEERS_FLATLIGHT_SCENE_H_
