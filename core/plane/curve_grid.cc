// SPDX-License-Identifier: Apache-2.0
#include "core/plane/curve_grid.h"

#include <cstddef>
#include <vector>

#include "core/plane/grid_builder.h"

namespace flatlight {
namespace {

// Beyond this share a new grid is hardly slower to get.
constexpr double kMostChanged = 0.25;
// So many times as large as it was built a grid may become, if it is not small: what changes leave behind stays.
constexpr std::size_t kMostGrown = 2;
constexpr std::size_t kSmall = 4096;

bool SamePlace(const Element& l, const Element& r) {
  return l.a == r.a && l.b == r.b && l.center == r.center && l.radius == r.radius && l.radial_a == r.radial_a &&
         l.radial_b == r.radial_b && l.sweep_angle == r.sweep_angle;
}

}  // namespace

CurveGrid::CurveGrid(const Scene& scene) {
  if (!scene.elements().empty()) GridBuilder(scene, *this).Build();
  built_size_ = cells_.size() + blocks_.size();
}

std::optional<CurveGrid> CurveGrid::Refit(const Scene& before, const Scene& after) const {
  const std::size_t size = after.elements().size();
  if (size == 0 || before.elements().size() != size || before.touch_distance() != after.touch_distance()) {
    return std::nullopt;
  }
  std::vector<std::uint32_t> changed;
  for (std::size_t i = 0; i < size; ++i) {
    const Element &old_element = before.elements()[i], &element = after.elements()[i];
    if (old_element.kind != element.kind || old_element.carrier != element.carrier) return std::nullopt;
    if (!SamePlace(old_element, element)) changed.push_back(static_cast<std::uint32_t>(i));
  }
  if (static_cast<double>(changed.size()) > kMostChanged * static_cast<double>(size)) return std::nullopt;
  CurveGrid refitted = *this;
  if (!changed.empty() && !GridBuilder(after, refitted).Update(before, changed)) return std::nullopt;
  const std::size_t grown = refitted.cells_.size() + refitted.blocks_.size();
  if (grown > kMostGrown * built_size_ + kSmall) return std::nullopt;
  return refitted;
}

}  // namespace flatlight
