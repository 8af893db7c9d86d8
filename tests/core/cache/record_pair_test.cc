// SPDX-License-Identifier: Apache-2.0
// What two records of functions that are known tell of what is between them.
#include "core/cache/record_pair.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace flatlight {
namespace {

using Function = std::function<std::array<double, kRecordOrders>(double)>;

CacheRecord RecordOf(const Function& function, double at, std::size_t known = kRecordOrders) {
  CacheRecord record;
  record.at = at;
  record.known = known;
  record.goes_on = true;
  record.scale = 1;
  const auto values = function(at);
  for (std::size_t k = 0; k < known; ++k) record.derivative[k] = {{values[k], 2 * values[k], 0}};
  return record;
}

// x^power.
Function Monomial(int power) {
  return [power](double x) {
    std::array<double, kRecordOrders> values{};
    double factor = 1;
    for (int k = 0; k < static_cast<int>(kRecordOrders) && k <= power; ++k) {
      values[static_cast<std::size_t>(k)] = factor * std::pow(x, power - k);
      factor *= power - k;
    }
    return values;
  };
}

TEST(RecordPairTest, PolynomialsOfTwiceTheKnownDerivativesAreExact) {
  for (const std::size_t degree : {0u, 1u, 2u}) {
    for (int power = 0; power <= 5; ++power) {
      const Function function = Monomial(power);
      const CacheRecord left = RecordOf(function, -0.5), right = RecordOf(function, 1.5);
      const RecordPair pair(left, right, degree);
      const bool exact = power <= 2 * static_cast<int>(degree) + 1;
      for (const double place : {-0.5, -0.1, 0.5, 1.2, 1.5}) {
        const double truth = std::pow(place, power), off = std::abs(pair.At(place)[0] - truth);
        EXPECT_NEAR(pair.At(place)[1], 2 * pair.At(place)[0], 1e-14);
        EXPECT_LE(exact ? off : 0, 1e-14) << degree << ' ' << power;
        // The largest channel's.
        EXPECT_LE(2 * off, pair.ErrorAt(place) * (1 + 1e-9) + 1e-14) << degree << ' ' << power << ' ' << place;
        EXPECT_LE(exact ? pair.ErrorAt(place) : 0, 1e-12) << degree << ' ' << power;
      }
    }
  }
}

TEST(RecordPairTest, TheEstimateIsCloseToTheError) {
  const Function wave = [](double x) {
    return std::array<double, kRecordOrders>{2 + std::sin(x), std::cos(x), -std::sin(x), -std::cos(x), std::sin(x)};
  };
  for (const std::size_t degree : {0u, 1u, 2u}) {
    for (const double width : {1.0, 0.5, 0.25}) {
      for (double at = 0; at < 3; at += 0.37) {
        const CacheRecord left = RecordOf(wave, at), right = RecordOf(wave, at + width);
        const RecordPair pair(left, right, degree);
        double error = 0, estimate = 0;
        for (double t = 0.05; t < 1; t += 0.05) {
          const double place = at + t * width, off = 2 * std::abs(pair.At(place)[0] - wave(place)[0]);
          EXPECT_LE(off, pair.ErrorAt(place) + 1e-14) << degree << ' ' << width << ' ' << place;
          error = std::max(error, off), estimate = std::max(estimate, pair.ErrorAt(place));
        }
        EXPECT_LE(estimate, 6 * error + 1e-13) << degree << ' ' << width << ' ' << at;
      }
    }
  }
}

// Such records see that they don't belong together.
TEST(RecordPairTest, AKinkThatNoEventTellsShows) {
  const Function kink = [](double x) {
    return x < 0.6 ? std::array<double, kRecordOrders>{1, 0, 0, 0, 0}
                   : std::array<double, kRecordOrders>{1 + 0.1 * (x - 0.6), 0.1, 0, 0, 0};
  };
  const CacheRecord left = RecordOf(kink, 0), right = RecordOf(kink, 1);
  const RecordPair pair(left, right, 2);
  for (const double place : {0.3, 0.5, 0.6, 0.7}) {
    const double off = 2 * std::abs(pair.At(place)[0] - kink(place)[0]);
    EXPECT_LE(off, 1.5 * pair.ErrorAt(place)) << place;
  }
}

TEST(RecordPairTest, RecordsWithAnEventBetweenAreNotJoined) {
  CacheRecord left = RecordOf(Monomial(1), 0), right = RecordOf(Monomial(1), 1);
  EXPECT_TRUE(RecordPair::Joins(left, right));
  EXPECT_FALSE(RecordPair::Joins(left, left));
  std::vector<VisibilityEvent> events(1);
  for (const double at : {0.5, 1.0}) {
    events[0].at = at;
    left.events = right.events = events;
    EXPECT_FALSE(RecordPair::Joins(left, right)) << at;
  }
  for (const double at : {-0.5, 0.0, 1.5}) {
    events[0].at = at;
    EXPECT_TRUE(RecordPair::Joins(left, right)) << at;
  }
  left.goes_on = false;
  EXPECT_FALSE(RecordPair::Joins(left, right));
}

}  // namespace
}  // namespace flatlight
