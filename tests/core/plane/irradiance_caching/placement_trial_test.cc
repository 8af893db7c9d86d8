// SPDX-License-Identifier: Apache-2.0
// What a number of records makes of direct light on a floor, by error control.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "core/cache/interpolation.h"
#include "core/cache/placement.h"
#include "core/execution/cancellation.h"
#include "core/plane/exact/exact.h"
#include "core/plane/irradiance_caching/record_maker.h"
#include "core/plane/irradiance_caching/track.h"
#include "core/plane/irradiance_caching/track_events.h"
#include "core/plane/ray_caster.h"
#include "core/plane/reference/mesh_maker.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

// Relative RMS error at the points of the first probe.
double ErrorOf(const SceneMaker& maker, ErrorControl control, std::size_t degree, std::size_t most) {
  const auto scene = maker.Build();
  const RayCaster caster(scene);
  const auto charts = ChartsOf(*scene);
  const Tracks tracks = TracksOf(*scene, caster);
  PlacementOptions options;
  options.control = control;
  options.degree = degree;
  options.most_records = most;
  Placement placement(tracks.points, options);
  RecordMakerOptions maker_options;
  maker_options.control = control;
  RecordMaker records_of(caster, charts, nullptr, maker_options);
  const Cancellation never;
  std::vector<CacheRecord> records;
  double cast = 0;
  std::uint32_t wave = 0;
  const std::vector<VisibilityEvent> events =
      EventsBetween(records_of.skyline(), tracks.tracks[0], tracks.points[0], never);
  if (control == ErrorControl::kVisibilityEvents) placement.SetEvents({events});
  for (auto places = placement.Next(records); !places.empty(); places = placement.Next(records)) {
    for (const RecordPlace& place : places) {
      records.push_back(records_of.Make(tracks.tracks[place.track], place.track, place.at, wave, never, cast));
      if (control == ErrorControl::kVisibilityEvents) records.back().events = events;
    }
    ++wave;
  }
  EXPECT_LE(records.size(), most);
  placement.SetFootprints(records);
  std::vector<const CacheRecord*> all;
  for (const CacheRecord& record : records) all.push_back(&record);
  const TrackInterpolation interpolation(all, degree, WeightingOf(control));
  ExactSolver exact(*scene, caster.bvh(), {});
  double squares = 0, mean = 0;
  for (const double at : tracks.points[0]) {
    const Interpolated value = interpolation.At(at);
    const double truth = exact.Evaluate(tracks.tracks[0].At(at)).irradiance[0];
    EXPECT_GT(value.records, 0u);
    squares += (value.irradiance[0] - truth) * (value.irradiance[0] - truth);
    mean += truth;
  }
  const auto n = static_cast<double>(tracks.points[0].size());
  return std::sqrt(squares / n) / (mean / n);
}

SceneMaker Floor() {
  SceneMaker maker = UnitLight();
  maker.Probe("floor", 257);
  return maker;
}

SceneMaker BlackWalls() {
  SceneMaker maker = Floor();
  maker.Segment("left", {0, 1}, {0, 0}).Segment("right", {1, 0}, {1, 1});
  return maker;
}

SceneMaker DimWall() {
  SceneMaker maker = Floor();
  maker.Segment("left", {0, 1}, {0, 0}).Segment("right", {1, 0}, {1, 1}, {.radiance = {0.1}});
  return maker;
}

SceneMaker Blocked(SceneMaker maker) {
  maker.Segment("blocker", {0.45, 0.5}, {0.7, 0.5});
  return maker;
}

// What the second derivative is for (Jarosz et al. 2012, section 7): walls mislead mean distances.
TEST(PlacementTrialTest, HessiansPlaceBetterBesideWalls) {
  for (const std::size_t n : {8u, 9u, 10u}) {
    for (const SceneMaker& maker : {BlackWalls(), DimWall()}) {
      const double split = ErrorOf(maker, ErrorControl::kSplitSphere, 1, n);
      EXPECT_GT(split, 2.5 * ErrorOf(maker, ErrorControl::kOcclusionHessian, 1, n)) << n;
      EXPECT_GT(split, 100 * ErrorOf(maker, ErrorControl::kVisibilityEvents, 1, n)) << n;
    }
  }
}

// Jarosz et al. 2012 report up to 7 times less error at equal numbers of records.
TEST(PlacementTrialTest, HessiansReachWhatIsReported) {
  for (const std::size_t records : {12, 20, 24})
    EXPECT_GT(ErrorOf(BlackWalls(), ErrorControl::kSplitSphere, 1, records) /
                  ErrorOf(BlackWalls(), ErrorControl::kOcclusionHessian, 1, records),
              7)
        << records;
}

TEST(PlacementTrialTest, EventsAndSecondOrderAreFarAhead) {
  struct Trial {
    SceneMaker maker;
    std::size_t records;
    double factor;
  };
  for (const auto& [maker, records, factor] :
       {Trial{Floor(), 8, 1000}, Trial{Floor(), 10, 1000}, Trial{DimWall(), 8, 1000}, Trial{DimWall(), 10, 1000},
        Trial{Blocked(Floor()), 8, 300}, Trial{Blocked(Floor()), 10, 1000}, Trial{Blocked(Floor()), 16, 1000},
        Trial{Blocked(DimWall()), 8, 300}, Trial{Blocked(DimWall()), 10, 1000}, Trial{Blocked(DimWall()), 16, 1000}}) {
    EXPECT_GT(ErrorOf(maker, ErrorControl::kSplitSphere, 1, records),
              factor * ErrorOf(maker, ErrorControl::kVisibilityEvents, 2, records))
        << records;
  }
}

// Records are joined across the events of the blocker, so there may be fewer of them than stretches.
TEST(PlacementTrialTest, EventsArePassedAlsoByFirstOrder) {
  for (const std::size_t n : {8u, 9u, 10u}) {
    for (const SceneMaker& maker : {Blocked(Floor()), Blocked(DimWall())}) {
      EXPECT_GT(ErrorOf(maker, ErrorControl::kSplitSphere, 1, n),
                10 * ErrorOf(maker, ErrorControl::kVisibilityEvents, 1, n))
          << n;
    }
  }
}

// Black walls and no walls shine alike.
TEST(PlacementTrialTest, EqualLightGivesEqualErrors) {
  for (const ErrorControl control :
       {ErrorControl::kRadiometricHessian, ErrorControl::kOcclusionHessian, ErrorControl::kVisibilityEvents}) {
    EXPECT_EQ(ErrorOf(Floor(), control, 1, 10), ErrorOf(BlackWalls(), control, 1, 10));
  }
}

TEST(PlacementTrialTest, MoreRecordsMakeLessError) {
  for (const SceneMaker& maker : {Floor(), DimWall(), Blocked(DimWall())}) {
    double before = 1;
    for (const std::size_t n : {5u, 10u, 20u, 40u}) {
      const double error = ErrorOf(maker, ErrorControl::kVisibilityEvents, 2, n);
      EXPECT_LT(error, 0.3 * before) << n;
      before = error;
    }
  }
}

}  // namespace
}  // namespace flatlight
