// SPDX-License-Identifier: Apache-2.0
// A bounding volume hierarchy over the elements of a scene.
#ifndef FLATLIGHT_CORE_PLANE_BVH_H_
#define FLATLIGHT_CORE_PLANE_BVH_H_

#include <cstdint>
#include <limits>
#include <vector>

#include "core/math/vec.h"
#include "core/scene/scene.h"

namespace flatlight {

struct Box {
  Point2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Point2 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  void Add(Point2 p);
  void Add(const Box& box);
  double HalfPerimeter() const { return (high.x - low.x) + (high.y - low.y); }
};

// Encloses the element, with a margin to spare on all sides.
Box BoxOf(const Element& element, double margin);

class Bvh {
 public:
  // A leaf holds elements order()[first, first + count); an inner node (count 0) has children first and first + 1.
  struct Node {
    Box box;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };
  static constexpr int kMaxDepth = 64;

  explicit Bvh(const Scene& scene);

  // Node 0 is the root. Empty if there are no elements.
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<std::uint32_t>& order() const { return order_; }

 private:
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_BVH_H_
