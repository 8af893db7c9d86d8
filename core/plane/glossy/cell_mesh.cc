// SPDX-License-Identifier: Apache-2.0
#include "core/plane/glossy/cell_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/math/trig.h"

namespace flatlight {
namespace {

constexpr double kWidths = 2.5;

}  // namespace

CellMesh::CellMesh(const Scene& scene, PanelMesh panels, const std::vector<Borders>& borders)
    : panels_(std::move(panels)) {
  for (const Element& element : scene.elements()) lobes_.push_back(GlossyLobe::Of(scene.curve(element.curve).material));
  for (std::size_t i = 0; i < panels_.size(); ++i) {
    first_.push_back(cells_.size());
    const std::size_t directions = LobeOf(i) ? kDirectionCoefficients : 1;
    double low = -1;
    for (std::size_t k = 0; k <= borders[i].size(); ++k) {
      const double high = k < borders[i].size() ? borders[i][k] : 1;
      cells_.push_back({static_cast<std::uint32_t>(i), low, high, directions, numbers_});
      numbers_ += cells_.back().numbers();
      low = high;
    }
  }
  first_.push_back(cells_.size());
}

CellMesh::Borders CellMesh::BordersOf(std::size_t panel) const {
  Borders borders;
  for (std::size_t i = first_[panel] + 1; i < first_[panel + 1]; ++i) borders.push_back(cells_[i].low);
  return borders;
}

CellMesh::Borders FirstBorders(const std::optional<GlossyLobe>& lobe) {
  if (!lobe) return {};
  const double half_turn = std::numbers::pi;
  const auto count = static_cast<int>(std::ceil(half_turn / std::min(kWidths * lobe->width(), 0.5 * half_turn)));
  CellMesh::Borders borders;
  for (int k = 1; k < count; ++k) {
    const SinCosValue turn = SinCos(half_turn * (static_cast<double>(k) / count - 0.5));
    borders.push_back(HalfTangent({turn.sin, turn.cos}));
  }
  return borders;
}

}  // namespace flatlight
