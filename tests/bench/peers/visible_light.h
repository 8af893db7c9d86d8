// SPDX-License-Identifier: Apache-2.0
// Irradiance from a visible polygon, to check one program's visibility by another's light.
#ifndef FLATLIGHT_TESTS_BENCH_PEERS_VISIBLE_LIGHT_H_
#define FLATLIGHT_TESTS_BENCH_PEERS_VISIBLE_LIGHT_H_

#include <optional>
#include <vector>

#include "core/math/vec.h"
#include "core/scene/description.h"
#include "tests/bench/segment_grid.h"

namespace flatlight {

class VisibleLight {
 public:
  // Segment i shines with radiance[i] on its front, the left of a to b.
  VisibleLight(const std::vector<SegmentDescription>& segments, const std::vector<double>& radiance);

  // At a point with a unit normal that sees a polygon (counter-clockwise). Nothing if a side of the polygon, other than
  // those in line with the point, lies on no segment.
  std::optional<double> Irradiance(Point2 point, Vector2 normal, const std::vector<Point2>& polygon);

 private:
  // The segment that passes through a place.
  std::optional<std::uint32_t> SegmentAt(Point2 place);

  const std::vector<SegmentDescription>& segments_;
  const std::vector<double>& radiance_;
  SegmentGrid grid_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_BENCH_PEERS_VISIBLE_LIGHT_H_
