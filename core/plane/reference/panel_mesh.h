// SPDX-License-Identifier: Apache-2.0
// Panels: stretches of reflecting sides, on each of which light is a polynomial.
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_PANEL_MESH_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_PANEL_MESH_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/plane/reference/chart.h"
#include "core/scene/scene.h"

namespace flatlight {

struct Panel {
  ElementId element = ElementId::kNone;
  Side side = Side::kFront;
  double low = 0;  // Numbers of the element's chart.
  double high = 1;
  static constexpr std::uint32_t kNew = 0xffffffff;
  std::uint32_t before = kNew;  // Its number in the mesh that this one was made of, if it was not split.

  // The place in the chart of a place in [-1, 1].
  double At(double x) const { return 0.5 * ((1 - x) * low + (1 + x) * high); }
  double Local(double u) const { return ((u - low) - (high - u)) / (high - low); }
};

class PanelMesh {
 public:
  // Panels come side by side of the elements, in their order along each.
  PanelMesh(std::size_t elements, std::vector<Panel> panels);

  const std::vector<Panel>& panels() const { return panels_; }
  std::size_t size() const { return panels_.size(); }
  struct Range {
    std::size_t first = 0;
    std::size_t last = 0;  // One past.
  };
  Range On(ElementId element, Side side) const {
    const std::size_t index = IndexOf(element, side);
    return {first_[index], first_[index + 1]};
  }
  static std::size_t IndexOf(ElementId element, Side side) {
    return 2 * static_cast<std::size_t>(element) + (side == Side::kFront ? 0u : 1u);
  }

 private:
  std::vector<Panel> panels_;
  std::vector<std::size_t> first_;  // By element and side.
};

// Charts of all elements.
std::vector<Chart> ChartsOf(const Scene& scene);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_PANEL_MESH_H_
