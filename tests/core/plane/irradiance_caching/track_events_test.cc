// SPDX-License-Identifier: Apache-2.0
// Events along a floor, and that what they tell of jumps is what it takes to join records across them.
#include "core/plane/irradiance_caching/track_events.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "core/cache/record_pair.h"
#include "core/execution/executor.h"
#include "core/plane/irradiance_caching/reflected_series.h"
#include "core/plane/irradiance_caching/skyline.h"
#include "core/plane/irradiance_caching/track.h"
#include "core/plane/ray_caster.h"
#include "core/plane/reference/panel_mesh.h"
#include "core/plane/reference/reference_solver.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

// Along a scene's first track.
class EventsOnTrack {
 public:
  // With what curves reflect, if they do.
  EventsOnTrack(const SceneMaker& maker, bool reflects)
      : scene_(maker.Build()),
        caster_(std::make_shared<const RayCaster>(scene_)),
        charts_(ChartsOf(*scene_)),
        tracks_(TracksOf(*scene_, *caster_)) {
    if (reflects) {
      ReferenceOptions options;
      options.derivatives = 0;
      options.channels = 1;
      options.target_error = 1e-7;
      solver_ = std::make_unique<ReferenceSolver>(scene_, caster_, options);
      InlineExecutor executor;
      while (solver_->state() == ReferenceSolver::State::kWorks)
        solver_->Advance(executor, 1, Cancellation(), SteadyClock(), Clock::Duration::max());
      reflected_ =
          std::make_unique<ReflectedSeries>(*scene_, charts_, ReflectedLight{&solver_->mesh(), &solver_->light()});
    }
    skyline_ = std::make_unique<Skyline>(*caster_, charts_, reflects, reflected_.get());
    events_ = EventsBetween(*skyline_, tracks_.tracks[0], tracks_.points[0], Cancellation());
  }

  const std::vector<VisibilityEvent>& events() const { return events_; }
  std::array<Spectrum, kRecordOrders> Look(double at) {
    skyline_->LookFrom(tracks_.tracks[0].At(at));
    return skyline_->Irradiance();
  }
  CacheRecord RecordAt(double at) {
    CacheRecord record;
    record.at = at;
    record.derivative = Look(at);
    record.known = kRecordOrders;
    record.goes_on = true;
    record.scale = 1;
    record.events = events_;
    return record;
  }

 private:
  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<const RayCaster> caster_;
  std::vector<Chart> charts_;
  Tracks tracks_;
  std::unique_ptr<ReferenceSolver> solver_;
  std::unique_ptr<ReflectedSeries> reflected_;
  std::unique_ptr<Skyline> skyline_;
  std::vector<VisibilityEvent> events_;
};

SceneMaker BlockedFloor(double reflectance) {
  SceneMaker maker;
  maker.Segment("floor", {0, 0}, {1, 0}, {.reflectance = {reflectance}}).Probe("floor", 129);
  maker.Segment("lamp", {0.95, 1}, {0.1, 1}, {.reflectance = {reflectance}, .radiance = {1}});
  maker.Segment("right", {1, 0}, {1, 1.2}, {.reflectance = {reflectance}, .radiance = {0.1}});
  maker.Segment("blocker", {0.42, 0.52}, {0.68, 0.52}, {.reflectance = {reflectance}});
  return maker;
}

// Light that falls on a wall is bent where the wall begins to see the lamp past the blocker; where the floor begins to
// see such a place past the blocker, a derivative of its irradiance jumps.
TEST(TrackEventsTest, RecordsOfAllBouncesAreJoinedAcrossEvents) {
  EventsOnTrack direct(BlockedFloor(0), false), all(BlockedFloor(0.5), true);
  EXPECT_GE(direct.events().size(), 4u);
  EXPECT_GE(all.events().size(), direct.events().size() + 4);
  std::size_t inside = 0;
  for (EventsOnTrack* events : {&direct, &all}) {
    for (const VisibilityEvent& event : events->events()) {
      EXPECT_TRUE(event.known) << event.at;
      ASSERT_TRUE(event.before) << event.at;
      if (!(event.at > 0.05 && event.at < 0.95)) continue;
      ++inside;
      const double width = 0.02;
      const CacheRecord left = events->RecordAt(event.at - 0.4 * width),
                        right = events->RecordAt(event.at + 0.6 * width);
      ASSERT_TRUE(RecordPair::Joins(left, right));
      for (const std::size_t degree : {1u, 2u}) {
        const RecordPair pair(left, right, degree);
        const double place = event.at + 0.1 * width;
        // What a pair leaves where derivatives are of the order of (1/0.1)^k.
        EXPECT_NEAR(pair.At(place)[0], events->Look(place)[0][0], degree == 1 ? 3e-6 : 1e-8)
            << event.at << ' ' << degree;
      }
    }
  }
  EXPECT_GE(inside, 10u);
}

}  // namespace
}  // namespace flatlight
