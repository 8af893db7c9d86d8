// SPDX-License-Identifier: Apache-2.0
// Where curves stand on each other, so that what lies on one side of that place says nothing of the other side.
#ifndef FLATLIGHT_CORE_PLANE_WALLS_H_
#define FLATLIGHT_CORE_PLANE_WALLS_H_

#include <cstddef>
#include <vector>

#include "core/math/vec.h"
#include "core/plane/box.h"
#include "core/scene/scene.h"

namespace flatlight {

// Directions that differ by less are one.
inline constexpr double kSameDirection = 1e-9;

// Whether a curve goes on without a corner where the first of its elements ends and the second one begins.
bool GoesOn(const Element& before, const Element& after);

struct Wall {
  double at = 0;  // Arc length along the element.
  ElementId other = ElementId::kNone;
};

// Of each element: where others touch or cross it, in order; also those of its own curve that meet it in a corner.
class Walls {
 public:
  explicit Walls(const Scene& scene);

  const std::vector<Wall>& On(std::size_t element) const { return on_[element]; }

 private:
  template <typename Along, typename Across>
  void Sweep(const std::vector<Box>& boxes, Along along, Across across);
  void Meet(std::uint32_t i, std::uint32_t j);

  const Scene& scene_;
  double near_;
  std::vector<std::vector<Wall>> on_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_WALLS_H_
