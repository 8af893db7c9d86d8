// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/panel_mesh.h"

#include <utility>

namespace flatlight {

PanelMesh::PanelMesh(std::size_t elements, std::vector<Panel> panels)
    : panels_(std::move(panels)), first_(2 * elements + 1, 0) {
  for (const Panel& panel : panels_) ++first_[IndexOf(panel.element, panel.side) + 1];
  for (std::size_t i = 0; i + 1 < first_.size(); ++i) first_[i + 1] += first_[i];
}

std::vector<Chart> ChartsOf(const Scene& scene) {
  std::vector<Chart> charts;
  charts.reserve(scene.elements().size());
  for (const Element& element : scene.elements()) charts.emplace_back(element);
  return charts;
}

}  // namespace flatlight
