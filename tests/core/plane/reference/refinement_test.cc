// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/refinement.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "core/plane/reference/visibility_events.h"

namespace flatlight {
namespace {

// Of a panel from 0 to 1 with an event every 20th.
std::vector<Cell> ManyCells() {
  std::vector<Event> events;
  for (int k = 1; k < 20; ++k) events.push_back({0.05 * k, 10});
  return CellsBetween(events, 0, 1);
}

TEST(RefinementTest, CellsLieBetweenStrongEvents) {
  const std::vector<Cell> cells = ManyCells();
  ASSERT_EQ(cells.size(), 20u);
  for (std::size_t k = 0; k < cells.size(); ++k) {
    EXPECT_LT(cells[k].low, cells[k].place);
    EXPECT_GT(cells[k].high, cells[k].place);
    EXPECT_EQ(cells[k].low, k == 0 ? 0 : cells[k - 1].high);
  }
  EXPECT_EQ(cells.back().high, 1);
  EXPECT_TRUE(CellsBetween({{0.5, 0.1}}, 0, 1).empty());
  EXPECT_TRUE(CellsBetween({{0.5, 10}}, 0.6, 1).empty());
}

TEST(RefinementTest, APanelIsSplitWhereItIsOffMost) {
  std::vector<Cell> cells = ManyCells();
  cells[12].off = 1;
  const std::vector<double> places = SplitPlaces({}, cells, {});
  ASSERT_FALSE(places.empty());
  EXPECT_LE(places.size(), 3u);
  EXPECT_NEAR(places.back(), 0.65, 0.051);
}

TEST(RefinementTest, APanelThatIsOffNowhereIsSplitEvenly) {
  const std::vector<double> places = SplitPlaces({}, ManyCells(), {});
  ASSERT_EQ(places.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(places[k], 0.25 * static_cast<double>(k + 1), 0.051);
}

}  // namespace
}  // namespace flatlight
