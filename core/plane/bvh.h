// SPDX-License-Identifier: Apache-2.0
// A bounding volume hierarchy over the elements of a scene: eight children a node, a node a cache line.
//
// A node keeps what lies in it as whole numbers of 8 bits on a grid of its own, rounded so that nothing is lost:
// whoever walks the tree tests eight children at once in single precision, and computes in double with the few elements
// that remain. After Ylitie, Karras and Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
// BVHs"; new here are leaves that hold the ends of segments in the same way, and frames: parts of the scene that are
// small for single precision have coordinates of their own, so that curves may differ in size by any ratio.
#ifndef FLATLIGHT_CORE_PLANE_BVH_H_
#define FLATLIGHT_CORE_PLANE_BVH_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "core/math/vec.h"
#include "core/plane/box.h"
#include "core/scene/scene.h"

namespace flatlight {

// Coordinates of a part of the scene: a point of the scene is center + size * p, with p in [-1, 1]^2.
struct BvhFrame {
  Point2 center;
  double size = 1;  // A power of two.
  double inverse_size = 1;

  Point2 ToScene(Point2 p) const { return {center.x + size * p.x, center.y + size * p.y}; }
  Box ToScene(const Box& box) const { return {ToScene(box.low), ToScene(box.high)}; }
};

struct alignas(64) BvhNode {
  static constexpr int kWidth = 8;
  // Boxes enclose their contents with this to spare on all sides, in steps of the grid, for walks that round.
  static constexpr double kSpareSteps = 0.375;
  // Nodes below this extent, in coordinates of their frame, get a frame of their own: what single precision rounds at
  // coordinates near 1 stays below what is to spare.
  static constexpr double kLeastExtent = 0x1p-9;

  enum class Kind : std::uint8_t {
    kInner,  // Lanes are boxes of nodes first, first + 1, ...
    kBoxes,  // Lanes are boxes of the elements in slots first, first + 1, ...
    kEnds,   // Lanes are segments in such slots: low is the end a, high the end b, rounded to the nearest.
    kFrame,  // Node first is all that lies in frame `frame`.
  };
  // Boxes that are not in use are inside out, so that no ray meets them.
  std::uint8_t low_x[kWidth] = {255, 255, 255, 255, 255, 255, 255, 255};
  std::uint8_t low_y[kWidth] = {255, 255, 255, 255, 255, 255, 255, 255};
  std::uint8_t high_x[kWidth] = {};
  std::uint8_t high_y[kWidth] = {};
  // A whole number q is the coordinate origin + q * step in the node's frame.
  float origin_x = 0;
  float origin_y = 0;
  float step = 1;
  float inverse_step = 1;
  std::uint32_t first = 0;
  std::uint32_t frame = 0;  // kFrame alone.
  std::uint8_t count = 0;   // Lanes in use.
  Kind kind = Kind::kInner;

  // Encloses what a lane holds (kInner, kBoxes), in the node's frame.
  Box BoxOfLane(int lane) const;
};
static_assert(sizeof(BvhNode) == 64);

class Bvh {
 public:
  static constexpr int kMaxDepth = 40;

  // An element where leaves need it: in the order of the leaves, close together.
  struct Slot {
    Point2 a;
    Point2 b;
    std::uint32_t element = 0;
    std::uint32_t carrier = 0;  // See Element.
  };

  explicit Bvh(const Scene& scene);

  // The tree of a scene that differs little from the one this was made for: only what changed is done again. Absent if
  // too much changed, or if the tree would become a bad one (its boxes larger by half in all): then build a new one.
  std::optional<Bvh> Refit(const Scene& before, const Scene& after) const;

  // Node 0 is the root. Empty if there are no elements.
  const std::vector<BvhNode>& nodes() const { return nodes_; }
  const std::vector<Slot>& slots() const { return slots_; }
  // Frame 0 is the scene's.
  const std::vector<BvhFrame>& frames() const { return frames_; }
  // Encloses everything, with a margin.
  const Box& bounds() const { return bounds_; }

 private:
  // Both false if the tree would not do.
  bool RefitNodes(const Scene& scene, const std::vector<char>& changed);
  bool RefitNode(const Scene& scene, std::uint32_t frame_index, std::vector<Box>& boxes, std::size_t index);

  std::vector<BvhNode> nodes_;
  std::vector<Slot> slots_;
  std::vector<BvhFrame> frames_{BvhFrame{}};
  Box bounds_;
  double cost_ = 0;  // Half the perimeters of all nodes' boxes when it was built.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_BVH_H_
