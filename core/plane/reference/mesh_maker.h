// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_MESH_MAKER_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_MESH_MAKER_H_

#include <cstddef>
#include <vector>

#include "core/plane/reference/panel_mesh.h"

namespace flatlight {

// The places on each element where another one meets it, by element: there light has a singularity.
std::vector<std::vector<double>> Meetings(const Scene& scene, const std::vector<Chart>& charts);

// Panels on everything that reflects, with at most one end at a meeting.
PanelMesh MeshBetween(const Scene& scene, const std::vector<std::vector<double>>& meetings);

// Panels split at places of their elements, in any order.
PanelMesh SplitMeshAt(const Scene& scene, const PanelMesh& mesh, std::vector<std::vector<double>> places);

// Each panel split at its own places, which increase and lie inside; none: it stays.
PanelMesh SplitMesh(const Scene& scene, const PanelMesh& mesh, const std::vector<std::vector<double>>& places);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_MESH_MAKER_H_
