// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_STRETCHES_H_
#define FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_STRETCHES_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/math/vec.h"
#include "core/scene/scene.h"

namespace flatlight {

// One side of a stretch of a curve, the place of what has no bearing on any other.
enum class SideId : std::uint32_t {};

// A place by arc length from the stretch's beginning.
struct SidePlace {
  SideId side{};
  double at = 0;
};

// All curves, cut into stretches along which irradiance of either side has no reason to jump but a shadow's edge: they
// end at corners, at open ends, and where another curve touches or crosses. Smooth joints of a curve are no ends; a
// round curve that nothing touches has none.
class Stretches {
 public:
  explicit Stretches(const Scene& scene);

  std::size_t count() const { return lengths_.size(); }
  double length(SideId side) const { return lengths_[static_cast<std::size_t>(side) / 2]; }
  // Whether the end goes on at the beginning.
  bool closed(SideId side) const { return closed_[static_cast<std::size_t>(side) / 2] != 0; }

  // A point on an element; one where two stretches meet belongs to the one that begins there.
  SidePlace Locate(ElementId element, Point2 on_element, Side side) const;

 private:
  // What of an element lies in one stretch.
  struct Piece {
    double begin = 0;   // Arc length from the element's own beginning.
    double offset = 0;  // From there to the stretch's: at = offset + arc length along the element.
    std::uint32_t stretch = 0;
  };

  const Scene& scene_;
  std::vector<std::uint32_t> first_piece_;  // By element, and one past the last.
  std::vector<Piece> pieces_;
  std::vector<double> lengths_;  // By stretch.
  std::vector<char> closed_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_STRETCHES_H_
