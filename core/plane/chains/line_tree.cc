// SPDX-License-Identifier: Apache-2.0
#include "core/plane/chains/line_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace flatlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Bounds {
  std::array<double, 3> low = {kInfinity, kInfinity, kInfinity};
  std::array<double, 3> high = {-kInfinity, -kInfinity, -kInfinity};

  void Add(const Beam& beam) {
    const std::array<const Bernstein*, 3> parts = {&beam.lines.x, &beam.lines.y, &beam.lines.moment};
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], parts[i]->Min());
      high[i] = std::max(high[i], parts[i]->Max());
    }
  }
};

std::array<double, 3> MiddleOf(const Beam& beam) {
  Bounds bounds;
  bounds.Add(beam);
  std::array<double, 3> middle;
  for (std::size_t i = 0; i < 3; ++i) middle[i] = 0.5 * (bounds.low[i] + bounds.high[i]);
  return middle;
}

}  // namespace

LineTree::LineTree(const std::vector<Beam>& beams) : order_(beams.size()) {
  if (beams.empty()) return;
  std::iota(order_.begin(), order_.end(), 0u);
  nodes_.reserve(2 * beams.size());
  nodes_.emplace_back();
  Build(beams, 0, 0, static_cast<std::uint32_t>(beams.size()));
}

// Halves at the median along the axis in which the middles lie farthest apart.
void LineTree::Build(const std::vector<Beam>& beams, std::uint32_t node, std::uint32_t first, std::uint32_t end) {
  Bounds bounds;
  std::array<double, 3> low = {kInfinity, kInfinity, kInfinity}, high = {-kInfinity, -kInfinity, -kInfinity};
  for (std::uint32_t i = first; i < end; ++i) {
    bounds.Add(beams[order_[i]]);
    const std::array<double, 3> middle = MiddleOf(beams[order_[i]]);
    for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], middle[k]), high[k] = std::max(high[k], middle[k]);
  }
  const auto range = [&](std::size_t i) {
    return Range{0.5 * (bounds.low[i] + bounds.high[i]), 0.5 * (bounds.high[i] - bounds.low[i])};
  };
  nodes_[node].x = range(0), nodes_[node].y = range(1), nodes_[node].moment = range(2);
  if (end - first <= kLeafSize) {
    nodes_[node].first = first, nodes_[node].count = end - first;
    return;
  }
  std::size_t axis = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (high[i] - low[i] > high[axis] - low[axis]) axis = i;
  const std::uint32_t middle = first + (end - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t i, std::uint32_t k) {
                     const double a = MiddleOf(beams[i])[axis], b = MiddleOf(beams[k])[axis];
                     return a < b || (a == b && i < k);
                   });
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = child;
  Build(beams, child, first, middle);
  Build(beams, child + 1, middle, end);
}

}  // namespace flatlight
