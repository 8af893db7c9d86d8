// SPDX-License-Identifier: Apache-2.0
#include "core/sampling/sample_stream.h"

#include <gtest/gtest.h>

#include <algorithm>
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

// Alone and all together: 2^k points of each of the eight members of a group are a net of 2^(k + 3).
TEST(SampleStreamTest, MembersOfAGroupFillFinerIntervalsTogether) {
  for (const std::uint64_t seed : {0u, 5u}) {
    for (unsigned k = 0; k <= 9; ++k) {
      for (const std::uint32_t first : {0u, 2u << k, 3u << k}) {
        std::vector<SamplePair> points;
        for (std::uint32_t member = 0; member < SampleStream::kMembers; ++member) {
          const SampleStream stream = SampleStream::Member(seed, 2, 1, member);
          for (std::uint32_t i = 0; i < (1u << k); ++i) points.push_back(stream.Pair(first + i, 4));
        }
        for (unsigned rows_log = 0; rows_log <= k + 3; ++rows_log) {
          const std::size_t rows = std::size_t{1} << rows_log, columns = std::size_t{8} << k >> rows_log;
          std::vector<int> hits(rows * columns);
          for (const SamplePair& p : points) ++hits[Cell(p.u, columns) * rows + Cell(p.v, rows)];
          for (const int n : hits) ASSERT_EQ(n, 1) << "2^" << k << " points of a member, " << rows << " rows";
        }
      }
    }
  }
}

// What holds for all k that indices of 32 bits leave room for: the digits that decide on an elementary interval, as
// linear forms of the index's k bits and the member's three, are independent.
TEST(SobolTest, SharedNetsHaveMatricesOfFullRank) {
  for (unsigned k = 0; k <= 29; ++k) {
    for (unsigned rows = 0; rows <= k + 3; ++rows) {
      const unsigned columns = k + 3 - rows;
      std::vector<std::uint64_t> digits;  // Of the two numbers: the columns of the matrix.
      for (unsigned bit = 0; bit < k + 3; ++bit) {
        const std::uint32_t index = bit < k ? 1u << bit : 0;
        const std::uint32_t copy = bit < k ? 0 : 1u << (bit - k);
        const std::uint64_t u = (index ^ kFirstShifts[copy]) & ((std::uint64_t{1} << columns) - 1);
        const std::uint64_t v = (SobolSecondDimension(index) ^ kSecondShifts[copy]) & ((std::uint64_t{1} << rows) - 1);
        digits.push_back(u << rows | v);
      }
      std::size_t rank = 0;
      for (unsigned bit = 0; bit < 64; ++bit) {
        const auto pivot = std::find_if(digits.begin() + static_cast<std::ptrdiff_t>(rank), digits.end(),
                                        [&](std::uint64_t d) { return (d >> bit) & 1; });
        if (pivot == digits.end()) continue;
        std::iter_swap(digits.begin() + static_cast<std::ptrdiff_t>(rank), pivot);
        for (std::size_t i = rank + 1; i < digits.size(); ++i)
          if ((digits[i] >> bit) & 1) digits[i] ^= digits[rank];
        ++rank;
      }
      ASSERT_EQ(rank, k + 3) << rows << " rows";
    }
  }
}

// What two dimensions do together is as noisy for members of a group as for replicates that share nothing, which have
// twice the variance of samples that are unrelated: two successive indices lie in other halves of both dimensions.
// Would members share the order of their indices it were 1.2 times that, and 1.4 times with the same names in all
// dimensions. 20,000 trials tell a variance to 1 %.
TEST(SampleStreamTest, MembersAreUnrelatedAcrossDimensions) {
  constexpr int kTrials = 20'000;
  constexpr std::uint32_t kSamples = 64;
  double squares = 0;
  for (std::uint64_t seed = 0; seed < kTrials; ++seed) {
    double sum = 0;
    for (std::uint32_t member = 0; member < SampleStream::kMembers; ++member) {
      const SampleStream stream = SampleStream::Member(seed, 0, 0, member);
      for (std::uint32_t i = 0; i < kSamples; ++i)
        sum += (stream.Pair(i, 0).u < 0.5) == (stream.Pair(i, 1).u < 0.5) ? 1 : -1;
    }
    squares += sum * sum / kTrials;
  }
  EXPECT_NEAR(squares / (2 * kSamples * SampleStream::kMembers), 1, 0.06);
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

TEST(SampleStreamTest, EachSampleOfAMemberIsUniformOverSeeds) {
  for (const std::uint32_t member : {1u, 6u}) {
    std::vector<int> counts(16 * 16);
    for (std::uint64_t seed = 0; seed < 100'000; ++seed) {
      const SamplePair p = SampleStream::Member(seed, 3, 1, member).Pair(9, 2);
      ++counts[Cell(p.u, 16) * 16 + Cell(p.v, 16)];
    }
    EXPECT_LT(NormalScore(ChiSquare(counts), 255), kScoreLimit) << member;
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
TEST(SampleStreamTest, ReplicatesGroupsPointsSeedsAndDimensionsAreIndependent) {
  std::array<std::vector<int>, 8> counts;
  counts.fill(std::vector<int>(16 * 16));
  for (std::uint64_t n = 0; n < 60'000; ++n) {
    const auto index = static_cast<std::uint32_t>(n % 8);
    const std::uint64_t point = n % 3;
    const SampleStream stream(n, point, 0);
    const SampleStream member = SampleStream::Member(n, point, 0, 3);
    const double u = stream.Pair(index, 0).u;
    const double u_of_member = member.Pair(index, 0).u;
    const std::array<std::array<double, 2>, 8> pairs = {{
        {u, SampleStream(n + 1, point, 0).Pair(index, 0).u},
        {u, SampleStream(n, point + 1, 0).Pair(index, 0).u},
        {u, SampleStream(n, point, 1).Pair(index, 0).u},
        {u, stream.Pair(index, 1).u},
        {u, stream.Single(index, 0)},
        {u, u_of_member},
        {u_of_member, SampleStream::Member(n, point, 1, 3).Pair(index, 0).u},
        {member.Single(index, 0), SampleStream::Member(n, point, 0, 4).Single(index, 0)},
    }};
    for (std::size_t k = 0; k < pairs.size(); ++k) ++counts[k][Cell(pairs[k][0], 16) * 16 + Cell(pairs[k][1], 16)];
  }
  for (std::size_t k = 0; k < counts.size(); ++k) {
    EXPECT_LT(NormalScore(ChiSquare(counts[k]), 255), kScoreLimit) << k;
  }
}

// Any two copies come out as any two, all alike likely: 56 outcomes.
TEST(SobolTest, PairsOfCopiesAreRenamedEvenly) {
  for (std::uint32_t first = 0; first < kSharedNets; ++first) {
    for (std::uint32_t second = first + 1; second < kSharedNets; ++second) {
      std::vector<int> counts(64);
      for (std::uint64_t n = 0; n < 56'000; ++n) {
        const std::uint64_t key = MixBits(n);
        const std::uint32_t a = RenamedCopy(first, key), b = RenamedCopy(second, key);
        ASSERT_NE(a, b);
        ++counts[8 * a + b];
      }
      for (std::size_t i = 7; i < 8; --i) counts.erase(counts.begin() + static_cast<std::ptrdiff_t>(9 * i));
      EXPECT_LT(NormalScore(ChiSquare(counts), 55), kScoreLimit) << first << ", " << second;
    }
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
