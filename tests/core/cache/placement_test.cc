// SPDX-License-Identifier: Apache-2.0
// Placement and interpolation of records of functions that are known.
#include "core/cache/placement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/cache/interpolation.h"

namespace flatlight {
namespace {

// A function with its first four derivatives.
using Function = std::function<std::array<double, kRecordOrders>(double)>;

std::array<double, kRecordOrders> Wave(double x) {
  const double s = std::sin(3 * x), c = std::cos(3 * x);
  return {2 + s, 3 * c, -9 * s, -27 * c, 81 * s};
}

std::vector<double> Points(std::size_t count, double low, double high) {
  std::vector<double> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back(low + (high - low) * (static_cast<double>(i) + 0.5) / static_cast<double>(count));
  return points;
}

// Makes records until placement wants no more, and sets their footprints.
std::vector<CacheRecord> Fill(const Placement& placement, const Function& function,
                              const std::vector<VisibilityEvent>& events = {}) {
  std::vector<CacheRecord> records;
  for (std::uint32_t wave = 0;; ++wave) {
    const std::vector<RecordPlace> places = placement.Next(records);
    if (places.empty()) break;
    EXPECT_LT(wave, 50u);
    for (const RecordPlace& place : places) {
      CacheRecord record;
      record.track = place.track;
      record.at = place.at;
      record.wave = wave;
      record.known = kRecordOrders;
      const auto values = function(place.at);
      for (std::size_t k = 0; k < kRecordOrders; ++k) record.derivative[k] = Spectrum::Grey(values[k]);
      record.events = events;
      records.push_back(record);
    }
  }
  placement.SetFootprints(records);
  return records;
}

double WorstError(const std::vector<CacheRecord>& records, const std::vector<double>& points, std::uint32_t track,
                  std::size_t degree, const Function& function) {
  std::vector<const CacheRecord*> own;
  for (const CacheRecord& record : records)
    if (record.track == track) own.push_back(&record);
  const TrackInterpolation interpolation(own, degree, Weighting::kError);
  double worst = 0;
  for (const double point : points) {
    const Interpolated value = interpolation.At(point);
    EXPECT_GT(value.records, 0u) << point;
    const double truth = function(point)[0], error = std::abs(value.irradiance[0] - truth);
    worst = std::max(worst, error / truth);
  }
  return worst;
}

TEST(PlacementTest, ToleranceIsKept) {
  const std::vector<double> points = Points(400, 0, 4);
  for (const std::size_t degree : {0u, 1u, 2u}) {
    std::size_t before = points.size() + 1;
    for (const double tolerance : {1e-4, 1e-3, 1e-2}) {
      const Placement placement({points}, {.degree = degree, .tolerance = tolerance});
      const std::vector<CacheRecord> records = Fill(placement, Wave);
      EXPECT_LE(WorstError(records, points, 0, degree, Wave), 1.5 * tolerance) << degree << ' ' << tolerance;
      EXPECT_LT(records.size(), before) << degree << ' ' << tolerance;
      before = records.size();
    }
  }
}

TEST(PlacementTest, ABudgetIsSpentAndNotExceeded) {
  const std::vector<std::vector<double>> points = {Points(300, 0, 1), Points(300, 5, 11), Points(3, 20, 20.1)};
  for (const std::size_t budget : {3u, 4u, 10u, 31u}) {
    const Placement placement(points, {.degree = 2, .most_records = budget});
    const std::vector<CacheRecord> records = Fill(placement, Wave);
    EXPECT_EQ(records.size(), budget);
    for (std::uint32_t track = 0; track < 3; ++track) WorstError(records, points[track], track, 2, Wave);
  }
}

// The range of a record's error, up to `most`.
double RangeOf(const CacheRecord& record, double tolerance, double most) {
  double range = 0;
  while (range < most && record.SmoothError(range) <= tolerance) range += 1e-3;
  return range;
}

TEST(PlacementTest, NeighboursClampEachOther) {
  const std::vector<double> points = Points(400, 0, 4);
  for (const ErrorControl control : {ErrorControl::kOcclusionHessian, ErrorControl::kVisibilityEvents}) {
    PlacementOptions options{.control = control, .degree = 1, .tolerance = 0.05};
    const std::size_t without = Fill(Placement({points}, options), Wave).size();
    options.clamp_neighbours = true;
    const std::vector<CacheRecord> records = Fill(Placement({points}, options), Wave);
    EXPECT_GE(records.size(), without);
    for (const CacheRecord& a : records) {
      for (const CacheRecord& b : records) {
        EXPECT_LE(RangeOf(a, options.tolerance, 4), RangeOf(b, options.tolerance, 4) + std::abs(a.at - b.at) + 2e-3);
      }
    }
  }
}

TEST(PlacementTest, AnOvertureMakesMoreOverlap) {
  const std::vector<double> points = Points(400, 0, 4);
  PlacementOptions options{.control = ErrorControl::kOcclusionHessian, .degree = 1, .tolerance = 0.01};
  const auto overlap = [&] {
    const std::vector<CacheRecord> records = Fill(Placement({points}, options), Wave);
    std::vector<const CacheRecord*> all;
    for (const CacheRecord& record : records) all.push_back(&record);
    const TrackInterpolation interpolation(all, 1, Weighting::kDistance);
    double count = 0;
    for (const double point : points) count += static_cast<double>(interpolation.At(point).records);
    return count / static_cast<double>(points.size());
  };
  const double plain = overlap();
  options.overture = true;
  EXPECT_GT(overlap(), 1.1 * plain);
}

// Irradiance beside a corner that reflects, of which a few derivatives say little.
TEST(PlacementTest, EstimatesHoldBesideACorner) {
  const Function corner = [](double x) {
    return std::array<double, kRecordOrders>{2 + x * std::log(x), std::log(x) + 1, 1 / x, -1 / (x * x),
                                             2 / (x * x * x)};
  };
  const std::vector<double> points = Points(400, 0, 1);
  for (const std::size_t degree : {1u, 2u}) {
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
      const Placement placement({points}, {.degree = degree, .tolerance = tolerance});
      EXPECT_LE(WorstError(Fill(placement, corner), points, 0, degree, corner), 1.02 * tolerance) << degree;
    }
  }
}

TEST(PlacementTest, NeverMoreRecordsThanPoints) {
  const std::vector<double> points = Points(7, 0, 50);
  const Placement placement({points}, {.degree = 1, .tolerance = 1e-9});
  const std::vector<CacheRecord> records = Fill(placement, Wave);
  EXPECT_LE(records.size(), points.size() + 3);
  EXPECT_LE(WorstError(records, points, 0, 1, Wave), 1e-9);
}

// Scaling lengths and light leaves records where they were.
TEST(PlacementTest, UnitsDoNotCount) {
  const double length = 0x1p-20, light = 0x1p30;
  const std::vector<double> points = Points(200, 0, 4);
  std::vector<double> scaled = points;
  for (double& point : scaled) point *= length;
  const Function dim = [&](double x) {
    auto values = Wave(x / length);
    double unit = light;
    for (double& value : values) value *= unit, unit /= length;
    return values;
  };
  for (const ErrorControl control : {ErrorControl::kVisibilityEvents, ErrorControl::kOcclusionHessian}) {
    const std::vector<CacheRecord> a = Fill(Placement({points}, {.control = control}), Wave);
    const std::vector<CacheRecord> b = Fill(Placement({scaled}, {.control = control}), dim);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_DOUBLE_EQ(a[i].at * length, b[i].at);
      EXPECT_DOUBLE_EQ(a[i].left_radius * length, b[i].left_radius);
    }
  }
}

// Light drops to almost nothing at 2.
TEST(PlacementTest, RecordsEndAtEvents) {
  const Function step = [](double x) {
    auto values = Wave(x);
    if (x >= 2)
      for (double& value : values) value *= 0.01;
    return values;
  };
  VisibilityEvent event;
  event.at = 2;
  const auto before = Wave(2);
  for (std::size_t k = 0; k < 3; ++k) event.jump[k] = Spectrum::Grey(-0.99 * before[k]);
  const std::vector<VisibilityEvent> events = {event};
  const std::vector<double> points = Points(401, 0, 4);
  const std::vector<CacheRecord> records = Fill(Placement({points}, {.degree = 2, .tolerance = 1e-3}), step, events);
  EXPECT_LE(WorstError(records, points, 0, 2, step), 2e-3);
  for (const CacheRecord& record : records) {
    if (record.at < 2) {
      EXPECT_LE(record.at + record.right_radius, 2 + 1e-12);
    } else {
      EXPECT_GE(record.at - record.left_radius, 2 - 1e-12);
    }
  }
}

// What an edge uncovers beyond each of some places, of which all is known or nothing.
struct Kinked {
  std::vector<VisibilityEvent> events;

  explicit Kinked(const std::vector<double>& places, bool known) {
    for (const double at : places) {
      VisibilityEvent& event = events.emplace_back();
      event.at = at;
      for (std::size_t k = 0; k < kRecordOrders; ++k) event.jump[k] = Spectrum::Grey(Uncovered(0)[k]);
      if (known) event.before = Spectrum::Grey(Before(events.size() - 1, at));
      event.known = known;
    }
  }
  // 1 - exp(-x)
  static std::array<double, kRecordOrders> Uncovered(double x) {
    const double e = std::exp(-x);
    return {1 - e, e, -e, e, -e};
  }
  double Before(std::size_t count, double x) const {
    double sum = Wave(x)[0];
    for (std::size_t i = 0; i < count; ++i) sum += Uncovered(x - events[i].at)[0];
    return sum;
  }
  Function function() const {
    return [this](double x) {
      auto values = Wave(x);
      for (const VisibilityEvent& event : events) {
        if (x < event.at) break;
        const auto more = Uncovered(x - event.at);
        for (std::size_t k = 0; k < kRecordOrders; ++k) values[k] += more[k];
      }
      return values;
    };
  }
};

TEST(PlacementTest, ToleranceIsKeptAcrossKnownEventsWithFewerRecords) {
  const std::vector<double> points = Points(400, 0, 4), places = {0.5, 0.6, 0.61, 1.9, 2.5, 3.3, 3.995};
  for (const std::size_t degree : {1u, 2u}) {
    for (const double tolerance : {1e-4, 1e-3, 1e-2}) {
      std::size_t count[2];
      for (const bool known : {false, true}) {
        const Kinked kinked(places, known);
        const Placement placement({points}, {.degree = degree, .tolerance = tolerance});
        const std::vector<CacheRecord> records = Fill(placement, kinked.function(), kinked.events);
        EXPECT_LE(WorstError(records, points, 0, degree, kinked.function()), 1.5 * tolerance)
            << degree << ' ' << tolerance << ' ' << known;
        count[known ? 1 : 0] = records.size();
      }
      EXPECT_LT(count[1], count[0]) << degree << ' ' << tolerance;
    }
  }
}

TEST(PlacementTest, ABudgetIsBestSpentAcrossKnownEvents) {
  const std::vector<double> points = Points(400, 0, 4), places = {0.5, 0.6, 0.61, 1.9, 2.5, 3.3, 3.995};
  for (const std::size_t degree : {1u, 2u}) {
    for (const std::size_t budget : {5u, 8u, 12u}) {
      double error[2];
      for (const bool known : {false, true}) {
        const Kinked kinked(places, known);
        Placement placement({points}, {.degree = degree, .most_records = budget});
        placement.SetEvents({kinked.events});
        const std::vector<CacheRecord> records = Fill(placement, kinked.function(), kinked.events);
        EXPECT_EQ(records.size(), budget);
        error[known ? 1 : 0] = WorstError(records, points, 0, degree, kinked.function());
      }
      EXPECT_LT(2 * error[1], error[0]) << degree << ' ' << budget;
    }
  }
}

TEST(PlacementTest, FootprintsMeetAcrossKnownEvents) {
  const std::vector<double> points = Points(400, 0, 4);
  const Kinked kinked({0.5, 1.9, 2.5, 3.3}, true);
  const std::vector<CacheRecord> records =
      Fill(Placement({points}, {.degree = 2, .most_records = 6}), kinked.function(), kinked.events);
  std::vector<const CacheRecord*> sorted;
  for (const CacheRecord& record : records) sorted.push_back(&record);
  std::sort(sorted.begin(), sorted.end(), [](const auto* a, const auto* b) { return a->at < b->at; });
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const double apart = sorted[i]->at - sorted[i - 1]->at;
    EXPECT_DOUBLE_EQ(sorted[i - 1]->right_radius, apart);
    EXPECT_DOUBLE_EQ(sorted[i]->left_radius, apart);
  }
}

}  // namespace
}  // namespace flatlight
