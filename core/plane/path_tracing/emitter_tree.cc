// SPDX-License-Identifier: Apache-2.0
#include "core/plane/path_tracing/emitter_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/plane/box.h"

namespace flatlight {
namespace {

// The mean of the positive part of a cosine over all directions: what an emitter gives that may face anywhere.
constexpr double kMeanCosine = 0.3183098861837907;
// No cluster is ruled out because it seems to face elsewhere.
constexpr double kLeastShare = 0.02;

}  // namespace

EmitterTree::EmitterTree(const std::vector<Emitter>& emitters) : order_(emitters.size()) {
  if (emitters.empty()) return;
  std::iota(order_.begin(), order_.end(), 0u);
  struct Task {
    std::uint32_t node, first, last;
  };
  nodes_.push_back({});
  std::vector<Task> tasks{{0, 0, static_cast<std::uint32_t>(emitters.size())}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    Node node = Summary(emitters, task.first, task.last);
    node.begin = task.first;
    if (task.last - task.first <= kLeafSize) {
      node.first = task.first;
      node.count = task.last - task.first;
    } else {
      // Halves by number, across the longer side.
      const bool by_x = node.half.x >= node.half.y;
      const std::uint32_t middle = task.first + (task.last - task.first) / 2;
      std::nth_element(order_.begin() + task.first, order_.begin() + middle, order_.begin() + task.last,
                       [&](std::uint32_t l, std::uint32_t r) {
                         const Emitter &a = emitters[l], &b = emitters[r];
                         const double x = by_x ? a.low.x + a.high.x : a.low.y + a.high.y;
                         const double y = by_x ? b.low.x + b.high.x : b.low.y + b.high.y;
                         return x < y || (x == y && l < r);
                       });
      node.first = static_cast<std::uint32_t>(nodes_.size());
      node.middle_place = middle;
      nodes_.resize(nodes_.size() + 2);
      tasks.push_back({node.first, task.first, middle});
      tasks.push_back({node.first + 1, middle, task.last});
    }
    nodes_[task.node] = node;
  }
}

EmitterTree::Node EmitterTree::Summary(const std::vector<Emitter>& emitters, std::uint32_t first,
                                       std::uint32_t last) const {
  Node node;
  Box box;
  for (std::uint32_t i = first; i < last; ++i) {
    const Emitter& emitter = emitters[order_[i]];
    box.Add(Box{emitter.low, emitter.high});
    node.power += emitter.power;
    node.facing = node.facing + emitter.facing;
  }
  node.half = 0.5 * (box.high - box.low);
  node.middle = box.low + node.half;
  node.radius_squared = LengthSquared(node.half);
  node.scattered = kMeanCosine * std::max(node.power - Length(node.facing), 0.0) + kLeastShare * node.power;
  return node;
}

double EmitterTree::Guess(const Node& node, const Vertex& vertex) {
  const Vector2 toward = node.middle - vertex.at.position;
  // How high the box reaches above the horizon.
  const double height =
      Dot(vertex.normal, toward) + std::abs(vertex.normal.x) * node.half.x + std::abs(vertex.normal.y) * node.half.y;
  if (!(height > 0)) return 0;
  // From within a cluster, or beside it, as from its rim.
  const double squared = std::max(LengthSquared(toward), node.radius_squared);
  const double distance = std::sqrt(squared);
  // Power, times the cosines at both ends, over the distance.
  const double given = std::max(-Dot(node.facing, toward), 0.0) + node.scattered * distance;
  return given * std::min(height, distance) / (squared * distance);
}

// take_first(node, share of the first child) answers whether to go there.
template <typename TakeFirst>
EmitterTree::Leaf EmitterTree::Walk(std::uint32_t cluster, const Vertex& vertex, TakeFirst take_first) const {
  Leaf leaf;
  const Node* node = &nodes_[cluster];
  double probability = 1;
  while (node->count == 0) {
    const Node& first = nodes_[node->first];
    const Node& second = nodes_[node->first + 1];
    const double of_first = Guess(first, vertex);
    const double both = of_first + Guess(second, vertex);
    if (!(both > 0)) return leaf;
    const double share = of_first / both;
    const bool go_first = take_first(*node, share);
    probability *= go_first ? share : 1 - share;
    node = go_first ? &first : &second;
    if (probability == 0) return leaf;
  }
  return {node->first, node->count, probability, 0};
}

EmitterTree::Leaf EmitterTree::ChooseIn(std::uint32_t cluster, const Vertex& vertex, double u) const {
  Leaf leaf = Walk(cluster, vertex, [&](const Node&, double share) {
    if (u < share) {
      u /= share;
      return true;
    }
    u = std::min((u - share) / (1 - share), 1.0);
    return false;
  });
  leaf.rest = u;
  return leaf;
}

EmitterTree::Leaf EmitterTree::FindIn(std::uint32_t cluster, const Vertex& vertex, std::uint32_t place) const {
  return Walk(cluster, vertex, [&](const Node& parent, double) { return place < parent.middle_place; });
}

EmitterTree::Leaf EmitterTree::Choose(const Vertex& vertex, double u) const {
  return Reaches(vertex) ? ChooseIn(0, vertex, u) : Leaf{};
}

EmitterTree::Leaf EmitterTree::Find(const Vertex& vertex, std::uint32_t place) const {
  return Reaches(vertex) ? FindIn(0, vertex, place) : Leaf{};
}

}  // namespace flatlight
