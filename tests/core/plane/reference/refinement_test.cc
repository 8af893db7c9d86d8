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
  const std::vector<double> places = SplitPlaces({}, cells, {}, {});
  ASSERT_FALSE(places.empty());
  EXPECT_LE(places.size(), 3u);
  EXPECT_NEAR(places.back(), 0.65, 0.051);
}

TEST(RefinementTest, APanelThatIsOffNowhereIsSplitEvenly) {
  const std::vector<double> places = SplitPlaces({}, ManyCells(), {}, {});
  ASSERT_EQ(places.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(places[k], 0.25 * static_cast<double>(k + 1), 0.051);
}

// Where nothing else tells; what is at an end already is left, and so is most of a panel beside a kink near its end.
TEST(RefinementTest, APanelIsSplitAtItsStrongestKink) {
  const std::vector<Event> kinks = {{0.2, 0.1}, {0.7, 0.4}, {0.8, 0.3}};
  EXPECT_EQ(SplitPlaces({}, {}, {}, kinks), std::vector<double>{0.7});
  Panel panel;
  panel.low = 0.7;
  EXPECT_EQ(SplitPlaces(panel, {}, {}, kinks), std::vector<double>{0.8});
  panel.low = 0.8;
  EXPECT_EQ(SplitPlaces(panel, {}, {}, kinks), std::vector<double>{0.9});
  panel.low = 0.1, panel.high = 0.6;
  EXPECT_EQ(SplitPlaces(panel, {}, {}, kinks), std::vector<double>{0.2});
  panel.low = 0.199;
  EXPECT_EQ(SplitPlaces(panel, {}, {}, kinks), (std::vector<double>{0.2, 0.4}));
}

TEST(RefinementTest, KinksAreThoseOfLightAlone) {
  const std::vector<std::vector<EventPlace>> found = {{{1, 0.5, 0.1, true}, {1, 0.6, 9, false}, {0, 0.3, 9, true}},
                                                      {{1, 0.2, 4, true}, {1, 0.5, 0.3, true}}};
  const Events kinks = SortedKinks(1, found), events = SortedEvents(1, found);
  ASSERT_EQ(kinks[1].size(), 2u);
  EXPECT_EQ(kinks[1][0].u, 0.2);
  EXPECT_EQ(kinks[1][1].u, 0.5);
  EXPECT_EQ(kinks[1][1].strength, 0.3);
  EXPECT_EQ(kinks[0].size(), 1u);
  ASSERT_EQ(events[1].size(), 2u);  // The weak ones are left out.
  EXPECT_EQ(events[1][1].u, 0.6);
}

}  // namespace
}  // namespace flatlight
