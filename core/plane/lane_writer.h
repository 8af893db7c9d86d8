// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_LANE_WRITER_H_
#define FLATLIGHT_CORE_PLANE_LANE_WRITER_H_

#include <cstddef>

#include "core/math/vec.h"
#include "core/plane/box.h"
#include "core/plane/bvh.h"

namespace flatlight {

// Writes the lanes of a node: from coordinates of the scene to whole numbers on the node's grid, which it lays over a
// box in the node's frame.
class LaneWriter {
 public:
  LaneWriter(const BvhFrame& frame, const Box& box, BvhNode& node);

  // What the lane encloses; lies in the box.
  void SetBox(std::size_t lane, const Box& box);
  // The ends of a segment, which lies in the box.
  void SetEnds(std::size_t lane, Point2 a, Point2 b);

 private:
  Point2 ToFrame(Point2 p) const;
  Point2 ToGrid(Point2 p) const;

  BvhNode& node_;
  const BvhFrame& frame_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_LANE_WRITER_H_
