// SPDX-License-Identifier: Apache-2.0
// Jumps at visibility events as series, against functions that are known.
#include "core/cache/visibility_event.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/cache/series_rest.h"

namespace flatlight {
namespace {

using Values = std::array<double, kRecordOrders>;

VisibilityEvent EventOf(const Values& jump) {
  VisibilityEvent event;
  // The second channel has most.
  for (std::size_t k = 0; k < kRecordOrders; ++k) event.jump[k] = {{jump[k], -2 * jump[k], 0}};
  return event;
}

// The derivatives of 1 / (1 - x) at 0.
constexpr Values kGeometric = {1, 1, 2, 6, 24};

TEST(VisibilityEventTest, DerivativesAreThoseOfTheSeries) {
  const VisibilityEvent event = EventOf({3, -2, 5, 7, -4});
  const auto value = [](double x) { return 3 - 2 * x + 2.5 * x * x + 7.0 / 6 * x * x * x - x * x * x * x / 6; };
  const auto slope = [](double x) { return -2 + 5 * x + 3.5 * x * x - 2.0 / 3 * x * x * x; };
  for (const double x : {-0.7, 0.0, 0.3, 1.0}) {
    EXPECT_NEAR(event.Derivative(0, x, kRecordOrders)[0], value(x), 1e-14);
    EXPECT_NEAR(event.Derivative(0, x, kRecordOrders)[1], -2 * value(x), 1e-14);
    EXPECT_NEAR(event.Derivative(1, x, kRecordOrders)[0], slope(x), 1e-14);
    EXPECT_NEAR(event.Derivative(0, x, 2)[0], 3 - 2 * x, 1e-14);
    EXPECT_NEAR(event.Derivative(1, x, 2)[0], -2, 1e-14);
    EXPECT_EQ(event.Derivative(2, x, 2)[0], 0);
    EXPECT_NEAR(event.Derivative(4, x, kRecordOrders)[0], -4, 1e-14);
  }
}

// The sum of x^k, whose terms shrink within 1 and grow beyond.
TEST(VisibilityEventTest, TermsThatGrowAreOfNoUse) {
  const VisibilityEvent event = EventOf(kGeometric);
  for (const double x : {-0.99, -0.2, 0.2, 0.99}) {
    EXPECT_EQ(event.OrdersOver(x), kRecordOrders) << x;
    EXPECT_EQ(event.Change(x)[0], event.Derivative(0, x, kRecordOrders)[0]);
  }
  for (const double x : {-1.01, 1.01, 30.0}) {
    EXPECT_EQ(event.OrdersOver(x), 1u) << x;
    EXPECT_EQ(event.Change(x)[0], 1) << x;
  }
  // Growing by the last term alone.
  EXPECT_EQ(EventOf({1, 1, 2, 6, 240}).OrdersOver(0.9), 4u);
}

// What is before the first that jumps tells nothing of how large it may be.
TEST(VisibilityEventTest, TheFirstThatJumpsIsOfUse) {
  EXPECT_EQ(EventOf({0, 5, 0, 0, 0}).OrdersOver(10), kRecordOrders);
  EXPECT_EQ(EventOf({0, 0, 5, 0, 0}).OrdersOver(10), kRecordOrders);
  EXPECT_EQ(EventOf({0, 0, 2, 6, 24}).OrdersOver(10), 3u);
  EXPECT_EQ(EventOf({0, 0, 0, 0, 0}).OrdersOver(10), kRecordOrders);
}

TEST(VisibilityEventTest, MostChangeIsThatOfTheFirstThreeTerms) {
  const VisibilityEvent event = EventOf({1, -3, 8, 600, 600});
  // By the channel that has most, without signs.
  for (const double x : {-0.5, 0.5}) EXPECT_DOUBLE_EQ(event.MostChange(x), 2 * (1 + 1.5 + 1));
}

// Of a geometric series the rest is known.
TEST(VisibilityEventTest, TheRestGoesOnLikeTheLastTerms) {
  const VisibilityEvent event = EventOf(kGeometric);
  for (const double x : {0.1, 0.3, 0.7}) {
    const double rest = std::pow(x, 5) / (1 - x);
    EXPECT_NEAR(event.Rest(x), 2 * rest, 1e-13);
    EXPECT_NEAR(event.Rest(-x), 2 * rest, 1e-13);
  }
  // Ratios count up to kMostRatio.
  EXPECT_DOUBLE_EQ(event.Rest(0.9), 2 * std::pow(0.9, 4) * kMostRatio / (1 - kMostRatio));
  // Beyond, of all that was left out.
  EXPECT_DOUBLE_EQ(event.Rest(2), 2 * 2 / (1 - kMostRatio));
  EXPECT_EQ(EventOf({0, 0, 0, 0, 0}).Rest(2), 0);
}

TEST(VisibilityEventTest, AnEventCountsOnItsRight) {
  std::vector<VisibilityEvent> events(4);
  events[0].at = 1, events[1].at = events[2].at = 2, events[3].at = 3;
  const auto first_and_count = [&](double low, double high) {
    const auto in = EventsIn(events, low, high);
    return std::pair(in.empty() ? -1 : in.data() - events.data(), in.size());
  };
  EXPECT_EQ(first_and_count(0, 4), std::pair(std::ptrdiff_t{0}, std::size_t{4}));
  EXPECT_EQ(first_and_count(1, 2), std::pair(std::ptrdiff_t{1}, std::size_t{2}));
  EXPECT_EQ(first_and_count(2, 3), std::pair(std::ptrdiff_t{3}, std::size_t{1}));
  EXPECT_EQ(first_and_count(0.5, 1), std::pair(std::ptrdiff_t{0}, std::size_t{1}));
  EXPECT_EQ(first_and_count(1, 1.5).second, 0u);
  EXPECT_EQ(first_and_count(3, 9).second, 0u);
  EXPECT_TRUE(IsLastInPlace(events, events[0]));
  EXPECT_FALSE(IsLastInPlace(events, events[1]));
  EXPECT_TRUE(IsLastInPlace(events, events[2]));
  EXPECT_TRUE(IsLastInPlace(events, events[3]));
}

}  // namespace
}  // namespace flatlight
