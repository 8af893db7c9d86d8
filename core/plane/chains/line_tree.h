// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_CHAINS_LINE_TREE_H_
#define FLATLIGHT_CORE_PLANE_CHAINS_LINE_TREE_H_

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/math/vec.h"
#include "core/plane/chains/beam.h"

namespace flatlight {

// Beams in a binary tree of boxes in the space of lines, of which each is a point (direction, moment): those that pass
// a place of the plane lie close to a plane there.
class LineTree {
 public:
  LineTree() = default;
  explicit LineTree(const std::vector<Beam>& beams);

  // Calls visit(index) for all beams of which a line may pass the point.
  template <typename Visit>
  void VisitNear(Point2 p, Visit visit) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, 64> stack;
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      const double left = node.x.middle * p.y - node.y.middle * p.x - node.moment.middle;
      const double spread = node.x.half * std::abs(p.y) + node.y.half * std::abs(p.x) + node.moment.half;
      if (std::abs(left) > spread + kRounding * (1 + std::abs(p.x) + std::abs(p.y))) continue;
      if (node.count > 0) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) visit(std::size_t{order_[i]});
      } else {
        stack[depth++] = node.first;
        stack[depth++] = node.first + 1;
      }
    }
  }

 private:
  static constexpr double kRounding = 1e-14;
  static constexpr std::uint32_t kLeafSize = 2;
  struct Range {
    double middle = 0;
    double half = 0;
  };
  struct Node {
    Range x, y, moment;
    std::uint32_t first = 0;  // Child, or place in order_.
    std::uint32_t count = 0;  // Of a leaf.
  };
  void Build(const std::vector<Beam>& beams, std::uint32_t node, std::uint32_t first, std::uint32_t end);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_CHAINS_LINE_TREE_H_
