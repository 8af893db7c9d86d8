// SPDX-License-Identifier: Apache-2.0
#include "core/sampling/sample_stream.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace flatlight {
namespace {

// Bounds for chi-square statistics: mean k and variance 2k for k degrees of freedom, nearly normal for the k used here
// (Wilson and Hilferty 1931), at 5 standard deviations. Failure rate of one test below 1e-6; seeds are fixed.
double NormalScore(double chi_square, double k) {
  return (std::cbrt(chi_square / k) - (1 - 2 / (9 * k))) / std::sqrt(2 / (9 * k));
}
constexpr double kScoreLimit = 5;

double ChiSquare(const std::vector<int>& counts) {
  double total = 0;
  for (const int n : counts) total += n;
  const double expected = total / static_cast<double>(counts.size());
  double sum = 0;
  for (const int n : counts) sum += (n - expected) * (n - expected) / expected;
  return sum;
}

std::size_t Cell(double u, std::size_t cells) { return static_cast<std::size_t>(u * static_cast<double>(cells)); }

TEST(SampleStreamTest, FirstPointsFillEveryElementaryInterval) {
  for (const std::uint64_t seed : {0u, 1u, 77u}) {
    for (const std::uint32_t dimension : {0u, 3u, 1000u}) {
      const SampleStream stream(seed, 5, 2);
      for (unsigned k = 0; k <= 10; ++k) {
        for (unsigned rows_log = 0; rows_log <= k; ++rows_log) {
          const std::size_t rows = std::size_t{1} << rows_log;
          const std::size_t columns = std::size_t{1} << (k - rows_log);
          std::vector<int> hits(rows * columns);
          for (std::uint32_t i = 0; i < (1u << k); ++i) {
            const SamplePair p = stream.Pair(i, dimension);
            ++hits[Cell(p.u, columns) * rows + Cell(p.v, rows)];
          }
          for (const int n : hits) ASSERT_EQ(n, 1) << "2^" << k << " points, " << rows << " rows";
        }
      }
    }
  }
}

TEST(SampleStreamTest, LaterAlignedBlocksAreNetsToo) {
  const SampleStream stream(9, 0, 0);
  for (std::uint32_t block = 0; block < 20; ++block) {
    std::array<int, 64> hits{};
    for (std::uint32_t i = 0; i < 64; ++i) {
      const SamplePair p = stream.Pair(64 * block + i, 1);
      ++hits[Cell(p.u, 8) * 8 + Cell(p.v, 8)];
    }
    for (const int n : hits) ASSERT_EQ(n, 1);
  }
}

// Over seeds one sample of a stream must be uniform in the square, or estimates would be biased.
TEST(SampleStreamTest, EachSampleIsUniformOverSeeds) {
  for (const std::uint32_t index : {0u, 1u, 5u, 4095u}) {
    std::vector<int> counts(16 * 16);
    for (std::uint64_t seed = 0; seed < 100'000; ++seed) {
      const SamplePair p = SampleStream(seed, 3, 7).Pair(index, 2);
      ++counts[Cell(p.u, 16) * 16 + Cell(p.v, 16)];
    }
    EXPECT_LT(NormalScore(ChiSquare(counts), 255), kScoreLimit) << index;
  }
}

TEST(SampleStreamTest, LowDigitsAreUniformToo) {
  for (const unsigned shift : {20u, 32u, 45u}) {
    std::vector<int> counts(256);
    const SampleStream stream(1, 2, 3);
    for (std::uint32_t i = 0; i < 100'000; ++i) {
      const double scaled = std::ldexp(stream.Pair(i, 0).u, static_cast<int>(shift));
      ++counts[Cell(scaled - std::floor(scaled), 256)];
    }
    EXPECT_LT(NormalScore(ChiSquare(counts), 255), kScoreLimit) << shift;
  }
}

// What neighbours in any coordinate of the key give must be unrelated: pairs of numbers fill the square evenly.
TEST(SampleStreamTest, ReplicatesPointsSeedsAndDimensionsAreIndependent) {
  std::array<std::vector<int>, 5> counts;
  counts.fill(std::vector<int>(16 * 16));
  for (std::uint64_t n = 0; n < 60'000; ++n) {
    const auto index = static_cast<std::uint32_t>(n % 8);
    const SampleStream stream(n, n % 3, 0);
    const double u = stream.Pair(index, 0).u;
    const std::array<double, 5> others = {
        SampleStream(n + 1, n % 3, 0).Pair(index, 0).u, SampleStream(n, n % 3 + 1, 0).Pair(index, 0).u,
        SampleStream(n, n % 3, 1).Pair(index, 0).u, stream.Pair(index, 1).u, stream.Single(index, 0)};
    for (std::size_t k = 0; k < others.size(); ++k) ++counts[k][Cell(u, 16) * 16 + Cell(others[k], 16)];
  }
  for (std::size_t k = 0; k < counts.size(); ++k) {
    EXPECT_LT(NormalScore(ChiSquare(counts[k]), 255), kScoreLimit) << k;
  }
}

// Owen's scrambling flips each digit by a coin of its own for every choice of the digits above it. Seven coins decide
// the first three digits: all 128 outcomes must be equally frequent over keys.
TEST(ScrambleTest, CoinsOfTheFirstThreeDigitsAreIndependent) {
  std::vector<int> counts(128);
  for (std::uint64_t n = 0; n < 200'000; ++n) {
    const std::uint64_t key = MixBits(n);
    std::size_t outcome = 0;
    unsigned coin = 0;
    for (unsigned digit = 0; digit < 3; ++digit) {
      for (std::uint64_t above = 0; above < (1u << digit); ++above, ++coin) {
        outcome |= static_cast<std::size_t>((ScrambleReversed(above, key) >> digit) & 1) << coin;
      }
    }
    ++counts[outcome];
  }
  EXPECT_LT(NormalScore(ChiSquare(counts), 127), kScoreLimit);
}

TEST(ScrambleTest, DigitsDependOnlyOnThoseAbove) {
  for (std::uint64_t n = 0; n < 1000; ++n) {
    const std::uint64_t x = MixBits(n);
    const std::uint64_t key = MixBits(~n);
    for (unsigned digit = 1; digit < 64; ++digit) {
      const std::uint64_t above = (std::uint64_t{1} << digit) - 1;
      ASSERT_EQ(ScrambleReversed(x, key) & above, ScrambleReversed(x & above, key) & above);
    }
  }
}

TEST(SobolTest, SecondDimensionFollowsTheDirectionNumbers) {
  // v_1 = 1/2, v_{k+1} = v_k ^ (v_k >> 1): the recurrence of the primitive polynomial x + 1.
  for (std::uint32_t index = 0; index < 5000; ++index) {
    std::uint32_t expected = 0;
    std::uint32_t direction = 0x80000000u;
    for (std::uint32_t rest = index; rest != 0; rest >>= 1, direction ^= direction >> 1) {
      if (rest & 1) expected ^= direction;
    }
    ASSERT_EQ(ReverseBits(SobolSecondDimension(index)), expected) << index;
  }
}

TEST(SampleStreamTest, EqualArgumentsGiveEqualNumbers) {
  EXPECT_EQ(SampleStream(1, 2, 3).Pair(4, 5).u, SampleStream(1, 2, 3).Pair(4, 5).u);
  EXPECT_EQ(SampleStream(1, 2, 3).Single(4, 5), SampleStream(1, 2, 3).Single(4, 5));
}

// The test of uniformity can fail: a warp that moves points by up to a fortieth of the square is rejected.
TEST(SampleStreamTest, ChiSquareRejectsASlightlyUnevenDistribution) {
  std::vector<int> counts(256);
  for (std::uint64_t seed = 0; seed < 100'000; ++seed) {
    SamplePair p = SampleStream(seed, 3, 7).Pair(0, 2);
    p.u -= 0.1 * p.u * (1 - p.u);
    ++counts[Cell(p.u, 16) * 16 + Cell(p.v, 16)];
  }
  EXPECT_GT(NormalScore(ChiSquare(counts), 255), kScoreLimit);
}

}  // namespace
}  // namespace flatlight
