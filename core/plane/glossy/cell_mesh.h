// SPDX-License-Identifier: Apache-2.0
// Cells: stretches of reflecting sides times ranges of directions, on each of which light is a polynomial of both.
#ifndef FLATLIGHT_CORE_PLANE_GLOSSY_CELL_MESH_H_
#define FLATLIGHT_CORE_PLANE_GLOSSY_CELL_MESH_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/plane/glossy/glossy_lobe.h"
#include "core/plane/materials/local_direction.h"
#include "core/plane/reference/panel_light.h"
#include "core/plane/reference/panel_mesh.h"
#include "core/scene/scene.h"

namespace flatlight {

// Directions are told by the tangent of half their angle from the normal, in [-1, 1]: a rational number for sine and
// cosine, and smooth up to the horizon.
inline double HalfTangent(LocalDirection direction) { return direction.sine / (1 + direction.cosine); }
inline LocalDirection DirectionOf(double half_tangent) {
  const double scale = 1 / (1 + half_tangent * half_tangent);
  return {2 * half_tangent * scale, (1 - half_tangent) * (1 + half_tangent) * scale};
}

// Of the direction in which light leaves; places have kLightCoefficients. Light of Lambertian panels has one.
inline constexpr std::size_t kDirectionCoefficients = 8;

struct DirectionCell {
  std::uint32_t panel = 0;
  double low = -1, high = 1;   // Of half tangents.
  std::size_t directions = 1;  // Coefficients of directions: 1 or kDirectionCoefficients.
  std::size_t first = 0;       // Of its numbers: by place, then direction.

  std::size_t numbers() const { return kLightCoefficients * directions; }
  double At(double y) const { return 0.5 * ((1 - y) * low + (1 + y) * high); }
  double Local(double t) const { return ((t - low) - (high - t)) / (high - low); }
};

class CellMesh {
 public:
  using Borders = std::vector<double>;  // Between the cells of a panel, increasing.

  // Borders by panel; those of Lambertian panels are empty.
  CellMesh(const Scene& scene, PanelMesh panels, const std::vector<Borders>& borders);

  const PanelMesh& panels() const { return panels_; }
  const std::vector<DirectionCell>& cells() const { return cells_; }
  std::size_t numbers() const { return numbers_; }
  PanelMesh::Range CellsOf(std::size_t panel) const { return {first_[panel], first_[panel + 1]}; }
  // Of light that leaves a panel with a half tangent.
  std::size_t CellAt(std::size_t panel, double half_tangent) const {
    std::size_t i = first_[panel];
    while (i + 1 < first_[panel + 1] && cells_[i].high <= half_tangent) ++i;
    return i;
  }
  // Absent: Lambertian.
  const std::optional<GlossyLobe>& LobeOf(std::size_t panel) const {
    return lobes_[static_cast<std::size_t>(panels_.panels()[panel].element)];
  }
  Borders BordersOf(std::size_t panel) const;

 private:
  PanelMesh panels_;
  std::vector<std::optional<GlossyLobe>> lobes_;  // By element.
  std::vector<DirectionCell> cells_;              // Panel by panel.
  std::vector<std::size_t> first_;                // By panel.
  std::size_t numbers_ = 0;
};

// To begin with: cells some widths of the lobe wide.
CellMesh::Borders FirstBorders(const std::optional<GlossyLobe>& lobe);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_GLOSSY_CELL_MESH_H_
