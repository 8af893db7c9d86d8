// SPDX-License-Identifier: Apache-2.0
#include "core/statistics/block_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace flatlight {
namespace {

// Values of very different size, so that the order of additions shows in the sum.
std::vector<double> Block(std::uint64_t block) {
  std::mt19937_64 random(block);
  std::uniform_real_distribution<double> exponent(-20, 20);
  return {std::exp2(exponent(random)), 1.0 / static_cast<double>(block + 1)};
}

std::vector<double> TotalOf(const BlockTree& tree) {
  std::vector<double> total(tree.width());
  tree.Total(total);
  return total;
}

TEST(BlockTreeTest, AnyCutIntoAlignedRangesGivesTheSameBits) {
  for (const std::uint64_t blocks : {1u, 2u, 7u, 64u, 100u, 333u}) {
    BlockTree one_by_one(2);
    for (std::uint64_t b = 0; b < blocks; ++b) one_by_one.Append(0, Block(b));
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
      std::mt19937 random(seed);
      BlockTree cut(2);
      while (cut.blocks() < blocks) {
        const unsigned level = BlockTree::AlignedLevel(cut.blocks(), blocks, static_cast<unsigned>(random() % 6));
        BlockTree range(2);
        for (std::uint64_t k = 0; k < (std::uint64_t{1} << level); ++k) range.Append(0, Block(cut.blocks() + k));
        cut.Append(level, TotalOf(range));
      }
      ASSERT_EQ(TotalOf(cut), TotalOf(one_by_one)) << blocks << " blocks, cut " << seed;
    }
  }
}

TEST(BlockTreeTest, OrderOfAdditionsWouldShow) {
  BlockTree tree(2);
  double running = 0;
  for (std::uint64_t b = 0; b < 333; ++b) {
    tree.Append(0, Block(b));
    running += Block(b)[1];
  }
  EXPECT_NE(TotalOf(tree)[1], running);
  EXPECT_NEAR(TotalOf(tree)[1], running, 1e-12 * running);
}

TEST(BlockTreeTest, AlignedLevelRespectsStartEndAndLimit) {
  EXPECT_EQ(BlockTree::AlignedLevel(0, 1, 10), 0u);
  EXPECT_EQ(BlockTree::AlignedLevel(0, 100, 10), 6u);
  EXPECT_EQ(BlockTree::AlignedLevel(0, 100, 3), 3u);
  EXPECT_EQ(BlockTree::AlignedLevel(4, 100, 10), 2u);
  EXPECT_EQ(BlockTree::AlignedLevel(5, 100, 10), 0u);
  EXPECT_EQ(BlockTree::AlignedLevel(64, 67, 10), 1u);
}

}  // namespace
}  // namespace flatlight
