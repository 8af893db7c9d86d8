// SPDX-License-Identifier: Apache-2.0
#include "core/statistics/misses_in_row.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <vector>

#include "core/statistics/replicates.h"
#include "tests/support/transport/honest_errors.h"

namespace flatlight {
namespace {

constexpr double kBright = 1;
constexpr std::size_t kPoints = 100;
using Row = std::vector<std::optional<RowPoint>>;

// One value in `rare` is bright.
Row RareRow(std::mt19937_64& random, double rare, double edge) {
  std::uniform_real_distribution<double> uniform;
  Row row(kPoints);
  for (std::optional<RowPoint>& point : row) {
    std::array<double, kReplicates> values;
    for (double& value : values) value = 0.01 * uniform(random) + (uniform(random) * rare < 1 ? kBright : 0);
    const Missable missable{kBright, kBright, 1 / std::sqrt(2.0 * kNeighbours + 1)};
    point = {HalvesSpreadOf(values), missable, edge};
  }
  return row;
}

MeanEstimate EstimateAt(const Row& row, const MissesInRow& misses, std::size_t point) {
  NearbyVariance nearby;
  nearby.missed = misses.At(point);
  return EstimateMean(row[point]->spread.All(), row[point]->missable, nearby);
}

// Most points meet none of 16 values, of which one in 60 is bright. From neighbours each learns the size of that.
TEST(MissesInRowTest, ErrorsHaveTheirSizeWhereMostPointsMissRareLight) {
  std::mt19937_64 random(1);
  constexpr double kRare = 60;
  const double truth = 0.005 + kBright / kRare;
  HonestErrors shared, alone;
  for (int run = 0; run < 100; ++run) {
    const Row row = RareRow(random, kRare, 0);
    const MissesInRow misses(row);
    for (std::size_t i = 0; i < kPoints; ++i) {
      const MeanEstimate estimate = EstimateAt(row, misses, i);
      shared.Add(estimate.mean, truth, estimate.StandardError());
      const MeanEstimate cautious = EstimateMean(row[i]->spread.All(), Missable{kBright, kBright});
      alone.Add(cautious.mean, truth, cautious.StandardError());
    }
  }
  EXPECT_GT(shared.MeanSquareZ(), 0.6);
  EXPECT_LT(shared.MeanSquareZ(), 1.1);
  EXPECT_LT(alone.MeanSquareZ(), 0.3);
}

// What none of 33 points met is that rare at most; an edge any of them may have met alone.
TEST(MissesInRowTest, WhatNobodyMetIsDoubted) {
  std::mt19937_64 random(2);
  const Row row = RareRow(random, 1e9, 0), with_edge = RareRow(random, 1e9, kBright);
  const double alone = EstimateMean(row[50]->spread.All(), Missable{kBright, kBright}).unresolved;
  const double shared = EstimateAt(row, MissesInRow(row), 50).unresolved;
  const double edge = EstimateAt(with_edge, MissesInRow(with_edge), 50).unresolved;
  EXPECT_NEAR(shared, std::sqrt(2.0) / (2 * kNeighbours + 1) * kBright / kHalfReplicates, 1e-12);
  EXPECT_NEAR(edge * edge, shared * shared + alone * alone / (2 * kNeighbours + 1), 1e-12);
}

TEST(MissesInRowTest, PointsWithoutValuesTellNothing) {
  std::mt19937_64 random(3);
  Row row = RareRow(random, 60, 1);
  for (std::size_t i = 0; i < kPoints; ++i)
    if (i != 40) row[i].reset();
  EXPECT_EQ(MissesInRow(row).At(40), MissesInRow({row[40]}).At(0));
}

}  // namespace
}  // namespace flatlight
