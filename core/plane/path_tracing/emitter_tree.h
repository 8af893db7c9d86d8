// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_PATH_TRACING_EMITTER_TREE_H_
#define FLATLIGHT_CORE_PLANE_PATH_TRACING_EMITTER_TREE_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/math/vec.h"
#include "core/plane/path_tracing/vertex.h"

namespace flatlight {

// Chooses among very many emitters in a time that grows with the logarithm of their number: a binary tree of clusters,
// walked from the root by chances in proportion to guesses at what each cluster gives the vertex. (As in space: Conty
// Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting"; in the plane light falls
// off with the distance itself, and the guess is one of ours.)
class EmitterTree {
 public:
  // The emitters of a leaf are to be weighed one by one.
  static constexpr std::uint32_t kLeafSize = 4;
  // OpenNear opens clusters that seem larger than this, half their size over their distance, while there are fewer than
  // so many; and all, if there are no more emitters.
  static constexpr double kOpenAngle = 0.25;
  static constexpr std::size_t kMostClusters = 256;

  struct Emitter {
    Point2 low, high;  // Its box.
    double power = 0;  // Positive.
    Vector2 facing;    // Power times the mean of the normals to which it emits: shorter, the more they differ.
  };

  EmitterTree() = default;
  explicit EmitterTree(const std::vector<Emitter>& emitters);

  // The emitters in the order of the leaves.
  const std::vector<std::uint32_t>& order() const { return order_; }

  // A few emitters side by side in that order, the chance of choosing them, and what the choice left of the random
  // number: uniform in [0, 1] again. No emitter of a leaf that cannot be chosen lights the vertex.
  struct Leaf {
    std::uint32_t first = 0;
    std::uint32_t count = 0;  // 0: nothing lights the vertex.
    double probability = 0;
    double rest = 0;
  };
  // False if it is certain that nothing lights the vertex.
  bool Reaches(const Vertex& vertex) const { return !nodes_.empty() && Guess(nodes_[0], vertex) > 0; }
  Leaf Choose(const Vertex& vertex, double u) const;
  // The leaf that holds a place in the order; `rest` has no meaning.
  Leaf Find(const Vertex& vertex, std::uint32_t place) const;

  // For a vertex that chooses many times: calls visit(cluster, guess, emitters) for clusters that together hold all
  // emitters which may light the vertex, in their order; near ones are opened, down to leaves. `guess` is what the
  // cluster gives if nothing blocks. The leaf is empty for a cluster that is not one.
  template <typename Visit>
  void OpenNear(const Vertex& vertex, Visit visit) const {
    if (nodes_.empty()) return;
    std::vector<std::uint32_t> open{0};
    std::size_t visited = 0;
    const bool few = order_.size() <= kMostClusters;
    while (!open.empty()) {
      const std::uint32_t cluster = open.back();
      const Node& node = nodes_[cluster];
      open.pop_back();
      const double guess = Guess(node, vertex);
      if (guess == 0) continue;
      const double distance_squared = LengthSquared(node.middle - vertex.at.position);
      const bool near = few || node.radius_squared > kOpenAngle * kOpenAngle * distance_squared;
      if (node.count == 0 && near && visited + open.size() < kMostClusters) {
        open.push_back(node.first + 1);
        open.push_back(node.first);
        continue;
      }
      ++visited;
      visit(cluster, guess, node.count == 0 ? Leaf{} : Leaf{node.first, node.count, 1, 0});
    }
  }
  // The same choices within a cluster.
  Leaf ChooseIn(std::uint32_t cluster, const Vertex& vertex, double u) const;
  Leaf FindIn(std::uint32_t cluster, const Vertex& vertex, std::uint32_t place) const;
  // The place of a cluster's first emitter in the order.
  std::uint32_t Begin(std::uint32_t cluster) const { return nodes_[cluster].begin; }

 private:
  struct Node {
    Point2 middle;
    Vector2 half;  // Half the width and height of the box.
    double radius_squared = 0;
    double power = 0;
    Vector2 facing;
    double scattered = 0;            // What the cluster gives in any direction, since not all of it faces one way.
    std::uint32_t first = 0;         // Leaf: its place in the order. Inner node: the first child; the second follows.
    std::uint32_t count = 0;         // 0: inner node.
    std::uint32_t middle_place = 0;  // Inner node: where the second child's emitters begin.
    std::uint32_t begin = 0;         // Its emitters' first place in the order.
  };

  Node Summary(const std::vector<Emitter>& emitters, std::uint32_t first, std::uint32_t last) const;
  static double Guess(const Node& node, const Vertex& vertex);
  template <typename TakeFirst>
  Leaf Walk(std::uint32_t cluster, const Vertex& vertex, TakeFirst take_first) const;

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_PATH_TRACING_EMITTER_TREE_H_
