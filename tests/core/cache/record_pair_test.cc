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

// Powers of x up to the fifth with these factors.
Function PolynomialOf(const std::vector<double>& factors) {
  return [factors](double x) {
    std::array<double, kRecordOrders> sum{};
    for (std::size_t power = 0; power < factors.size(); ++power) {
      const auto values = Monomial(static_cast<int>(power))(x);
      for (std::size_t k = 0; k < kRecordOrders; ++k) sum[k] += factors[power] * values[k];
    }
    return sum;
  };
}

struct Part {
  double from;
  Function function;
};

// Each from its place on, which belongs to it.
Function Joined(const std::vector<Part>& parts) {
  return [parts](double x) {
    std::size_t part = 0;
    while (part + 1 < parts.size() && x >= parts[part + 1].from) ++part;
    return parts[part].function(x);
  };
}

std::vector<VisibilityEvent> EventsOf(const std::vector<Part>& parts) {
  std::vector<VisibilityEvent> events;
  for (std::size_t i = 1; i < parts.size(); ++i) {
    VisibilityEvent& event = events.emplace_back();
    event.at = parts[i].from;
    event.known = true;
    const auto before = parts[i - 1].function(event.at), beyond = parts[i].function(event.at);
    event.before = Spectrum{{before[0], 2 * before[0], 0}};
    for (std::size_t k = 0; k < kRecordOrders; ++k) {
      const double jump = beyond[k] - before[k];
      event.jump[k] = {{jump, 2 * jump, 0}};
    }
  }
  return events;
}

// Light of which all is known: below each event a polynomial that has as many coefficients as two records tell, and
// other ones beyond. The power that no derivative tells is the same everywhere.
std::vector<Part> Polynomials(std::size_t degree, const std::vector<double>& events) {
  std::vector<Part> parts;
  for (std::size_t i = 0; i <= events.size(); ++i) {
    std::vector<double> factors;
    for (std::size_t power = 0; power <= 2 * degree + 1; ++power)
      factors.push_back(
          power < kRecordOrders ? std::cos(1 + 3 * static_cast<double>(i) + 7 * static_cast<double>(power)) : 0.3);
    parts.push_back({i == 0 ? -10 : events[i - 1], PolynomialOf(factors)});
  }
  return parts;
}

TEST(RecordPairTest, PolynomialsThatJumpAtKnownEventsAreExact) {
  const std::vector<std::vector<double>> cases = {{0.3}, {0.3, 0.5},   {0.3, 0.3, 0.7}, {-0.5},
                                                  {1},   {-1, 0.2, 2}, {0.2, 1},        {-0.5, -0.5, 1, 1}};
  for (const std::size_t degree : {0u, 1u, 2u}) {
    for (const std::vector<double>& places : cases) {
      const std::vector<Part> parts = Polynomials(degree, places);
      const std::vector<VisibilityEvent> events = EventsOf(parts);
      const Function function = Joined(parts);
      CacheRecord left = RecordOf(function, -0.5), right = RecordOf(function, 1);
      left.events = right.events = events;
      ASSERT_TRUE(RecordPair::Joins(left, right));
      const RecordPair pair(left, right, degree);
      for (const double place : {-0.5, -0.499, -0.1, 0.2, 0.3, 0.4, 0.5, 0.9, 0.999, 1.0}) {
        EXPECT_NEAR(pair.At(place)[0], function(place)[0], 1e-13) << degree << ' ' << places.size() << ' ' << place;
        EXPECT_LE(pair.ErrorAt(place), 1e-11);
      }
    }
  }
}

// 1/(h^2 + x^2), as the edge of something at height h changes light beyond an event at 0, on top of a wave.
TEST(RecordPairTest, EstimatesHoldAcrossEvents) {
  for (const std::size_t degree : {0u, 1u, 2u}) {
    for (const double height : {1.0, 0.5, 0.2, 0.05}) {
      const Function edge = [&](double x) {
        const double a = height, r = 1 / (a * a + x * x), r3 = r * r * r;
        return std::array<double, kRecordOrders>{
            a * a * (r - 1 / (a * a)), -2 * a * a * x * r * r, a * a * (6 * x * x - 2 * a * a) * r3,
            24 * a * a * x * (a * a - x * x) * r3 * r,
            24 * a * a * (5 * x * x * x * x - 10 * a * a * x * x + a * a * a * a) * r3 * r * r};
      };
      const Function wave = [](double x) {
        return std::array<double, kRecordOrders>{2 + std::sin(x), std::cos(x), -std::sin(x), -std::cos(x), std::sin(x)};
      };
      const Function sum = [&](double x) {
        auto values = wave(x);
        const auto more = edge(x - 0.1);
        for (std::size_t k = 0; k < kRecordOrders; ++k) values[k] += more[k];
        return values;
      };
      const std::vector<Part> parts = {{-10, wave}, {0.1, sum}};
      const std::vector<VisibilityEvent> events = EventsOf(parts);
      const Function function = Joined(parts);
      for (const double width : {0.8, 0.4, 0.2, 0.1}) {
        CacheRecord left = RecordOf(function, 0.1 - 0.3 * width), right = RecordOf(function, 0.1 + 0.7 * width);
        left.events = right.events = events;
        const RecordPair pair(left, right, degree);
        double worst = 0, estimate = 0;
        for (double t = 0.02; t < 1; t += 0.02) {
          const double place = left.at + t * width;
          worst = std::max(worst, 2 * std::abs(pair.At(place)[0] - function(place)[0]));
          estimate = std::max(estimate, pair.ErrorAt(place));
        }
        EXPECT_LE(worst, 1.5 * estimate + 1e-13) << degree << ' ' << height << ' ' << width;
      }
    }
  }
}

// What happens that no event tells shows where the light at an event is known.
TEST(RecordPairTest, WhatIsSeenAtAnEventCounts) {
  const std::vector<Part> parts = Polynomials(2, {0.3});
  std::vector<VisibilityEvent> events = EventsOf(parts);
  const Function function = Joined(parts);
  CacheRecord left = RecordOf(function, -0.5), right = RecordOf(function, 1);
  *events[0].before = *events[0].before + Spectrum::Grey(0.1);
  left.events = right.events = events;
  const RecordPair pair(left, right, 2);
  EXPECT_NEAR(pair.ErrorAt(0.3), 0.1, 1e-9);
  EXPECT_NEAR(pair.ErrorAt(-0.1), 0.05, 1e-9);
  EXPECT_LE(pair.ErrorAt(0.999), 1e-3);
}

TEST(RecordPairTest, ASingleRecordPassesKnownEventsToBothSides) {
  const std::vector<Part> parts = Polynomials(1, {-0.3, 0.2, 0.2, 0.6});
  const std::vector<VisibilityEvent> events = EventsOf(parts);
  const Function function = Joined(parts);
  for (const double at : {-0.5, -0.3, 0.0, 0.2, 0.4, 1.0}) {
    CacheRecord record = RecordOf(function, at);
    record.events = events;
    for (const double place : {-0.6, -0.3, -0.1, 0.2, 0.3, 0.6, 0.9})
      EXPECT_NEAR(Extrapolate(record, place, 3)[0], function(place)[0], 1e-13) << at << ' ' << place;
  }
}

TEST(RecordPairTest, RecordsWithAnEventBetweenWhoseJumpsAreNotKnownAreNotJoined) {
  CacheRecord left = RecordOf(Monomial(1), 0), right = RecordOf(Monomial(1), 1);
  EXPECT_TRUE(RecordPair::Joins(left, right));
  EXPECT_FALSE(RecordPair::Joins(left, left));
  std::vector<VisibilityEvent> events(2);
  events[0].at = 0.2, events[0].known = true;
  for (const double at : {0.5, 1.0}) {
    events[1].at = at;
    left.events = right.events = events;
    events[1].known = false;
    EXPECT_FALSE(RecordPair::Joins(left, right)) << at;
    EXPECT_EQ(left.EventToRight(), at);
    events[1].known = true;
    EXPECT_TRUE(RecordPair::Joins(left, right)) << at;
    // Of other light nothing is known.
    left.unknown_jump = 0.1;
    EXPECT_FALSE(RecordPair::Joins(left, right)) << at;
    left.unknown_jump = 0;
  }
  for (const double at : {-0.5, 0.0, 1.5}) {
    events[1].at = events[0].at = at;
    events[1].known = false;
    EXPECT_TRUE(RecordPair::Joins(left, right)) << at;
  }
  left.goes_on = false;
  EXPECT_FALSE(RecordPair::Joins(left, right));
}

}  // namespace
}  // namespace flatlight
