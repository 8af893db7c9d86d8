// SPDX-License-Identifier: Apache-2.0
#include "core/statistics/misses_in_row.h"

#include <gtest/gtest.h>

#include <array>
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

// One value in `rare` is bright; the scene would allow events `caution` times as bright.
Row RareRow(std::mt19937_64& random, double rare, double caution) {
  std::uniform_real_distribution<double> uniform;
  Row row(kPoints);
  for (std::optional<RowPoint>& point : row) {
    std::array<double, kReplicates> values;
    for (double& value : values) value = 0.01 * uniform(random) + (uniform(random) * rare < 1 ? kBright : 0);
    point = {HalvesSpreadOf(values), caution * kBright};
  }
  return row;
}

// Most points meet none of 16 values, of which one in 60 is bright. Alone each would have to expect ten times what
// there is; from neighbours it learns the size.
TEST(MissesInRowTest, ErrorsHaveTheirSizeWhereMostPointsMissRareLight) {
  std::mt19937_64 random(1);
  constexpr double kRare = 60, kCaution = 1;
  const double truth = 0.005 + kBright / kRare;
  HonestErrors shared, alone;
  for (int run = 0; run < 100; ++run) {
    const Row row = RareRow(random, kRare, kCaution);
    const MissesInRow misses(row);
    for (std::size_t i = 0; i < kPoints; ++i) {
      const MeanEstimate estimate = misses.Estimate(i);
      shared.Add(estimate.mean, truth, estimate.StandardError());
      const MeanEstimate cautious =
          EstimateMean(row[i]->spread.All(), Missable{kCaution * kBright, kCaution * kBright});
      alone.Add(cautious.mean, truth, cautious.StandardError());
    }
  }
  EXPECT_GT(shared.MeanSquareZ(), 0.35);
  EXPECT_LT(shared.MeanSquareZ(), 1.1);
  EXPECT_LT(alone.MeanSquareZ(), shared.MeanSquareZ() / 2);
}

// What none of 33 points met is that rare at most.
TEST(MissesInRowTest, WhatNobodyMetIsDoubted) {
  std::mt19937_64 random(2);
  const Row row = RareRow(random, 1e9, 1);
  const MissesInRow misses(row);
  const double alone = EstimateMean(row[50]->spread.All(), Missable{kBright, kBright}).unresolved;
  EXPECT_GT(misses.Estimate(50).unresolved, 0.1 * alone);
  EXPECT_LT(misses.Estimate(50).unresolved, 0.9 * alone);
}

TEST(MissesInRowTest, PointsWithoutValuesTellNothing) {
  std::mt19937_64 random(3);
  Row row = RareRow(random, 60, 10);
  for (std::size_t i = 0; i < kPoints; ++i)
    if (i != 40) row[i].reset();
  const MeanEstimate single = MissesInRow(row).Estimate(40);
  const MeanEstimate same = MissesInRow({&row[40], 1}).Estimate(0);
  EXPECT_EQ(single.StandardError(), same.StandardError());
}

}  // namespace
}  // namespace flatlight
