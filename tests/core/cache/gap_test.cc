// SPDX-License-Identifier: Apache-2.0
// What is expected of more records in a gap, where they go, and how a track falls into gaps.
#include "core/cache/gap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/cache/record_pair.h"

namespace flatlight {
namespace {

std::vector<double> Points(std::size_t count) {
  std::vector<double> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back((static_cast<double>(i) + 0.5) / static_cast<double>(count));
  return points;
}

CacheRecord RecordAt(double at) {
  CacheRecord record;
  record.at = at;
  record.known = kRecordOrders;
  record.derivative[0] = Spectrum::Grey(1);
  record.growth[3] = 1;
  record.scale = 1;
  record.degree = 2;
  record.goes_on = true;
  return record;
}

class GapTest : public ::testing::Test {
 protected:
  GapTest() {
    gap_.points = points_;
    gap_.high = 1;
    gap_.error = 0.1;
  }
  std::vector<double> points_ = Points(100);
  CacheRecord low_ = RecordAt(0), high_ = RecordAt(1);
  Gap gap_;
};

TEST_F(GapTest, ErrorsGoWithTheDistanceOfRecords) {
  EXPECT_EQ(gap_.ErrorWith(0, 2), 0.1);
  EXPECT_EQ(gap_.ErrorWith(100, 2), 0);
  // Alone a record has half of the gap to each side.
  EXPECT_DOUBLE_EQ(gap_.ErrorWith(2, 2), 0.1 / 16);
  gap_.before = &low_;
  EXPECT_DOUBLE_EQ(gap_.ErrorWith(2, 2), 0.1 / 25);
  gap_.after = &high_;
  EXPECT_DOUBLE_EQ(gap_.ErrorWith(2, 2), 0.1 / 9);
}

TEST_F(GapTest, JoinedErrorsFallTwiceAsFast) {
  gap_.joins = true;
  gap_.before = &low_;
  EXPECT_DOUBLE_EQ(gap_.ErrorWith(2, 3), 0.01 / std::pow(4, 6));
  gap_.after = &high_;
  EXPECT_DOUBLE_EQ(gap_.ErrorWith(2, 3), 0.1 / std::pow(3, 6));
  gap_.before = gap_.after = nullptr;
  EXPECT_DOUBLE_EQ(gap_.ErrorWith(1, 3), 0.1 / std::pow(2, 3));
  EXPECT_DOUBLE_EQ(gap_.ErrorWith(3, 3), 0.01 / std::pow(8, 6));
  // Where nothing is known all is off.
  gap_.error = std::numeric_limits<double>::infinity();
  EXPECT_DOUBLE_EQ(gap_.ErrorWith(3, 3), 1 / std::pow(8, 6));
}

// The last record before a corner is alone there, and x log x lets its error fall with its distance only.
TEST_F(GapTest, ErrorsBesideACornerFallWithTheLastDistance) {
  gap_.joins = true;
  for (const bool at_high : {true, false}) {
    gap_.before = at_high ? &low_ : nullptr;
    gap_.after = at_high ? nullptr : &high_;
    gap_.corners = {!at_high, at_high};
    for (const std::size_t count : {1u, 2u, 5u}) {
      const std::vector<double> places = gap_.Places(count, 3);
      ASSERT_EQ(places.size(), count);
      const double distance = at_high ? 1 - places.back() : places.front();
      EXPECT_NEAR(gap_.ErrorWith(count, 3), 0.1 * distance, 0.1 * 0.006) << count;
    }
    // At the other end it is joined.
    gap_.corners = {at_high, !at_high};
    EXPECT_LT(gap_.ErrorWith(2, 3), 1e-5);
  }
}

TEST_F(GapTest, PlacesAreEvenWhereLightIsAlikeAndCloserWhereItChanges) {
  gap_.before = &low_, gap_.after = &high_;
  gap_.joins = true;
  EXPECT_NEAR(gap_.Places(1, 3)[0], 0.5, 0.006);
  const std::vector<double> places = gap_.Places(3, 3);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(places[k], 0.25 * static_cast<double>(k + 1), 0.006);
  high_.growth[3] = 1e3;
  EXPECT_GT(gap_.Places(1, 3)[0], 0.6);
  // Up to a limit.
  high_.growth[3] = 1e30;
  EXPECT_LT(gap_.Places(1, 3)[0], 0.8);
}

TEST_F(GapTest, NoRecordOnAnother) {
  low_.at = points_.front(), high_.at = points_.back();
  gap_.before = &low_, gap_.after = &high_;
  const std::vector<double> places = gap_.Places(200, 3);
  EXPECT_EQ(places, std::vector<double>(points_.begin() + 1, points_.end() - 1));
}

TEST(FindGapsTest, RecordsVouchUpToEventsThatAreNotKnown) {
  const std::vector<double> points = Points(100);
  std::vector<VisibilityEvent> events(3);
  events[0].at = 0.3, events[1].at = 0.6, events[2].at = 0.7;
  events[0].known = true;
  CacheRecord left = RecordAt(0.105), right = RecordAt(0.905);
  left.events = right.events = events;
  const std::vector<const CacheRecord*> records = {&left, &right};
  const std::vector<Gap> gaps = FindGaps(points, records, {true, true});
  struct Expected {
    const CacheRecord *before, *after;
    std::size_t points;
    bool corner_low, corner_high;
  };
  const std::vector<Expected> expected = {{nullptr, &left, 10, true, false},
                                          {&left, nullptr, 50, false, false},
                                          {nullptr, nullptr, 10, false, false},
                                          {nullptr, &right, 20, false, false},
                                          {&right, nullptr, 10, false, true}};
  ASSERT_EQ(gaps.size(), expected.size());
  const double* next = points.data();
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    EXPECT_EQ(gaps[i].before, expected[i].before) << i;
    EXPECT_EQ(gaps[i].after, expected[i].after) << i;
    EXPECT_EQ(gaps[i].points.size(), expected[i].points) << i;
    EXPECT_EQ(gaps[i].points.data(), next) << i;
    EXPECT_EQ(gaps[i].corners.low, expected[i].corner_low) << i;
    EXPECT_EQ(gaps[i].corners.high, expected[i].corner_high) << i;
    EXPECT_TRUE(gaps[i].joins);
    double most = 0;
    for (const double point : gaps[i].points) most = std::max(most, std::min(left.CostAt(point), right.CostAt(point)));
    EXPECT_DOUBLE_EQ(gaps[i].error, most) << i;
    // No wider than what is wanted of it.
    EXPECT_TRUE(gaps[i].before || gaps[i].low == gaps[i].points.front()) << i;
    EXPECT_TRUE(gaps[i].after || gaps[i].high == gaps[i].points.back()) << i;
    next += gaps[i].points.size();
  }
}

// Joined records know more between them than either.
TEST(FindGapsTest, WhereRecordsAreJoinedTheirPairTells) {
  const std::vector<double> points = Points(100);
  const CacheRecord left = RecordAt(0), right = RecordAt(1);
  const std::vector<const CacheRecord*> records = {&left, &right};
  const std::vector<Gap> gaps = FindGaps(points, records, {});
  ASSERT_EQ(gaps.size(), 1u);
  const RecordPair pair(left, right, 2);
  EXPECT_EQ(gaps[0].points.size(), points.size());
  double most = 0, squares = 0;
  for (const double point : points) {
    most = std::max(most, pair.CostAt(point));
    squares += pair.CostAt(point) * pair.CostAt(point);
  }
  EXPECT_DOUBLE_EQ(gaps[0].error, most);
  EXPECT_DOUBLE_EQ(gaps[0].squares, squares);
  EXPECT_LT(most, 1e-12);
}

}  // namespace
}  // namespace flatlight
