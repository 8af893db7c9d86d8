// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_TRIANGULATION_PLANAR_CUTS_H_
#define FLATLIGHT_CORE_PLANE_TRIANGULATION_PLANAR_CUTS_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "core/plane/triangulation/mesh.h"
#include "core/scene/scene.h"

namespace flatlight {

// The segments of a scene as marked edges of a mesh: cut where they cross, and where one ends on another to within the
// touch distance.
struct PlanarCuts {
  // The mark of an edge that several elements cover; others have their element's number.
  static constexpr std::uint32_t kShared = 0xfffffffe;
  // All vertices but the corners lie in [-1, 1]^2, the mesh reaches to twice that.
  static constexpr double kHalf = 2;

  Mesh mesh;
  std::vector<float> uncertain;  // By vertex: how far it may be from where the scene has it, beside coordinate_error.
  std::vector<float> slit;       // By vertex: how far off it the elements may pass or end that go to it here.
};

// Absent if the scene has arcs, elements hardly longer than the touch distance, or very many crossings.
std::optional<PlanarCuts> CutSegments(const Scene& scene);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_TRIANGULATION_PLANAR_CUTS_H_
