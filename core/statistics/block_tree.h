// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_STATISTICS_BLOCK_TREE_H_
#define FLATLIGHT_CORE_STATISTICS_BLOCK_TREE_H_

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/check.h"

namespace flatlight {

// Sums of vectors over blocks 0 ... n-1, added in a fixed binary tree: the node of level k and place j is the sum of
// the nodes 2j and 2j+1 of level k-1. The sums' bits depend on the blocks alone, not on who added which of them, and
// rounding grows with log n only. Holds one node for each bit of n.
class BlockTree {
 public:
  explicit BlockTree(std::size_t width) : width_(width) {}

  std::size_t width() const { return width_; }
  std::uint64_t blocks() const { return blocks_; }

  // Appends the node of the blocks [blocks(), blocks() + 2^level). Requires that 2^level divides blocks().
  void Append(unsigned level, std::span<const double> node) {
    FLATLIGHT_DCHECK(node.size() == width_ && blocks_ % (std::uint64_t{1} << level) == 0);
    const std::uint64_t before = blocks_;
    blocks_ += std::uint64_t{1} << level;
    if (((before >> level) & 1) == 0) {
      nodes_.insert(nodes_.end(), node.begin(), node.end());
      return;
    }
    double* last = nodes_.data() + (nodes_.size() - width_);
    for (std::size_t i = 0; i < width_; ++i) last[i] += node[i];
    for (++level; (before >> level) & 1; ++level) {
      double* left = last - width_;
      for (std::size_t i = 0; i < width_; ++i) left[i] += last[i];
      nodes_.resize(nodes_.size() - width_);
      last = nodes_.data() + (nodes_.size() - width_);
    }
  }

  // The sums over all blocks: smaller nodes first.
  void Total(std::span<double> total) const {
    FLATLIGHT_DCHECK(total.size() == width_);
    std::fill(total.begin(), total.end(), 0.0);
    for (std::size_t end = nodes_.size(); end != 0; end -= width_) {
      for (std::size_t i = 0; i < width_; ++i) total[i] += nodes_[end - width_ + i];
    }
  }

  // One of them.
  double Total(std::size_t column) const {
    FLATLIGHT_DCHECK(column < width_);
    double total = 0;
    for (std::size_t end = nodes_.size(); end != 0; end -= width_) total += nodes_[end - width_ + column];
    return total;
  }

  // The level of the largest aligned range of blocks that begins at `first`, ends at or before `end` > first, and has
  // at most 2^max_level blocks.
  static unsigned AlignedLevel(std::uint64_t first, std::uint64_t end, unsigned max_level) {
    const auto fits = static_cast<unsigned>(std::bit_width(end - first) - 1);
    const auto aligned = first == 0 ? 63u : static_cast<unsigned>(std::countr_zero(first));
    return std::min({fits, aligned, max_level});
  }

  // What it holds, for a stream of states (see core/render/state_stream.h). The width stays.
  template <class Self, class Stream>
  static void State(Self& self, Stream& stream) {
    stream(self.blocks_, self.nodes_);
    stream.Require(self.nodes_.size() == static_cast<std::size_t>(std::popcount(self.blocks_)) * self.width_);
  }

 private:
  std::size_t width_;
  std::uint64_t blocks_ = 0;
  std::vector<double> nodes_;  // From the first blocks to the last.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_STATISTICS_BLOCK_TREE_H_
