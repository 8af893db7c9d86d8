// SPDX-License-Identifier: Apache-2.0
// A record's derivatives of direct light and of reflected light against independent ones: exact light's, the
// reference's, and differences of them.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "core/execution/executor.h"
#include "core/plane/exact/exact.h"
#include "core/plane/exact/light_solver.h"
#include "core/plane/irradiance_caching/reflected_series.h"
#include "core/plane/irradiance_caching/skyline.h"
#include "core/plane/irradiance_caching/track.h"
#include "core/plane/ray_caster.h"
#include "core/plane/reference/panel_mesh.h"
#include "core/plane/reference/reference_solver.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;

// The sixth-order central difference of a function's Hessian: its third and fourth derivative.
template <typename F>
void ExpectDerivatives(const F& hessian, double third, std::optional<double> fourth, double step, double tolerance) {
  const double a = hessian(step), b = hessian(-step), c = hessian(2 * step), d = hessian(-2 * step), e = hessian(0);
  const double f = hessian(3 * step), g = hessian(-3 * step);
  const double first = (45 * (a - b) - 9 * (c - d) + (f - g)) / (60 * step);
  const double second = (270 * (a + b) - 27 * (c + d) + 2 * (f + g) - 490 * e) / (180 * step * step);
  EXPECT_NEAR(third, first, tolerance * (1 + std::abs(first)));
  if (fourth) {
    EXPECT_NEAR(*fourth, second, 100 * tolerance * (1 + std::abs(second)));
  }
}

enum class Known { kFourth, kThird };

void ExpectRecordsAgree(const SceneMaker& maker, Known known = Known::kFourth) {
  const auto scene = maker.Build();
  const RayCaster caster(scene);
  const auto charts = ChartsOf(*scene);
  const ExactOptions options;
  ExactSolver exact(*scene, caster.bvh(), options);
  const LightSolver lights(caster, options);
  Skyline skyline(caster, charts, false);
  const Tracks tracks = TracksOf(*scene, caster);
  const auto evaluate = [&](const Receiver& receiver) {
    ExactValue value = exact.Evaluate(receiver);
    lights.Add(receiver, value);
    return value;
  };
  int smooth_places = 0;
  for (const TrackPlace& place : tracks.of_point) {
    SCOPED_TRACE(place.at);
    const Track& track = tracks.tracks[place.track];
    const Receiver receiver = track.At(place.at);
    skyline.LookFrom(receiver);
    const auto direct = skyline.Irradiance();
    const ExactValue value = evaluate(receiver);
    EXPECT_NEAR(direct[0][0], value.irradiance[0], 1e-13);
    EXPECT_NEAR(direct[1][0], value.gradient[0], 1e-11 * (1 + std::abs(value.gradient[0])));
    EXPECT_NEAR(direct[2][0], value.hessian[0], 1e-10 * (1 + std::abs(value.hessian[0])));
    const double step = 2e-4;
    const std::uint64_t here = skyline.Signature();
    bool smooth = true;
    for (const double d : {-3 * step, 3 * step}) {
      skyline.LookFrom(track.At(place.at + d));
      smooth = smooth && skyline.Signature() == here;
    }
    if (!smooth) continue;
    ++smooth_places;
    ExpectDerivatives([&](double d) { return evaluate(track.At(place.at + d)).hessian[0]; }, direct[3][0],
                      known == Known::kFourth ? std::optional<double>(direct[4][0]) : std::nullopt, step,
                      // Places along a Bézier are known to fewer digits.
                      known == Known::kFourth ? 1e-6 : 1e-4);
  }
  EXPECT_GT(smooth_places, 2);
}

TEST(RecordDerivativesTest, StraightReceiverWithBlocker) {
  SceneMaker maker = UnitLight();
  maker.Probe("floor", 9).Segment("blocker", {0.45, 0.5}, {0.7, 0.5});
  ExpectRecordsAgree(maker);
}

TEST(RecordDerivativesTest, DiscsOverAHillAndInABowl) {
  SceneMaker hill;
  hill.Arc("hill", {{0, -1}, 1, 2.2, -1.2}).Probe("hill", 9);
  hill.Segment("light", {1, 1}, {-1, 1.2}, {.radiance = {1}}).Arc("moon", {{0.25, 0.45}, 0.15, 0, -kFullTurn});
  ExpectRecordsAgree(hill);
  SceneMaker bowl;
  bowl.Arc("bowl", {{0, 1}, 1, 3.9, 1.6}).Probe("bowl", 9);
  bowl.Arc("sun", {{0.3, 1.2}, 0.2, 0, -kFullTurn}, {.radiance = {2}}).Segment("blocker", {-0.1, 0.7}, {0.2, 0.75});
  ExpectRecordsAgree(bowl);
}

// Along a Bézier the bend changes, and how it does.
TEST(RecordDerivativesTest, GroundThatBendsMoreAndMore) {
  SceneMaker maker;
  maker.Bezier("ground", {{-1, 0}, {-0.3, -0.6}, {0.2, 0.1}, {1, -0.1}}).Probe("ground", 9);
  maker.Segment("lamp", {0.6, 1.1}, {-0.4, 1}, {.radiance = {2}}).Arc("moon", {{0.5, 0.6}, 0.1, 0, -kFullTurn});
  ExpectRecordsAgree(maker, Known::kThird);
}

// A record's derivatives of light of all bounces against the reference's, whose panels it gathers from.
void ExpectReflectedAgrees(const SceneMaker& maker, bool light_is_smooth) {
  const auto scene = maker.Build();
  const auto caster = std::make_shared<const RayCaster>(scene);
  ReferenceOptions options;
  options.target_error = 1e-8;
  options.channels = 1;
  ReferenceSolver solver(scene, caster, options);
  InlineExecutor executor;
  const SteadyClock clock;
  const Cancellation never;
  while (solver.state() == ReferenceSolver::State::kWorks)
    solver.Advance(executor, 1, never, clock, Clock::Duration::max());
  const auto charts = ChartsOf(*scene);
  const ReflectedSeries reflected(*scene, charts, {&solver.mesh(), &solver.light()});
  Skyline skyline(*caster, charts, true, &reflected);
  const Tracks tracks = TracksOf(*scene, *caster);
  const auto look = [&](const Track& track, double at) {
    skyline.LookFrom(track.At(at));
    return skyline.Irradiance();
  };
  int smooth = 0;
  for (std::size_t i = 0; i < tracks.of_point.size(); ++i) {
    const TrackPlace& place = tracks.of_point[i];
    SCOPED_TRACE(place.at);
    const Track& track = tracks.tracks[place.track];
    const auto value = look(track, place.at);
    const std::uint64_t here = skyline.Signature();
    const ExactValue& reference = solver.values()[i];
    EXPECT_NEAR(value[0][0], reference.irradiance[0], reference.irradiance_error[0] + 1e-12);
    EXPECT_NEAR(value[1][0], reference.gradient[0], reference.gradient_error[0] + 1e-10);
    EXPECT_NEAR(value[2][0], reference.hessian[0], reference.hessian_error[0] + 1e-9);
    // Where an end of what is seen passes from panel to panel, light is smooth to their accuracy alone.
    const double step = 2e-3;
    bool is_smooth = true;
    for (const double d : {-3 * step, 3 * step}) {
      look(track, place.at + d);
      is_smooth = is_smooth && skyline.Signature() == here;
    }
    if (!is_smooth || !light_is_smooth) continue;
    ++smooth;
    ExpectDerivatives([&](double d) { return look(track, place.at + d)[2][0]; }, value[3][0], value[4][0], step, 1e-3);
  }
  EXPECT_GE(smooth, light_is_smooth ? 3 : 0);
}

TEST(RecordDerivativesTest, LightOfAllBounces) {
  SceneMaker room = SquareRoom({.reflectance = {0.7}}, 5);
  room.Segment("lamp", {0.31, 0.83}, {-0.27, 0.79}, {.radiance = {4}});
  room.Segment("blocker", {-0.23, 0.11}, {0.33, 0.19}, {.reflectance = {0.5}});
  ExpectReflectedAgrees(room, false);
  SceneMaker bowl;
  bowl.Arc("bowl", {{0, 0}, 1, 0, kFullTurn}, {.reflectance = {0.6}}).Probe("bowl", 9);
  bowl.Arc("sun", {{-0.25, 0.1}, 0.15, 0, -kFullTurn}, {.reflectance = {0.1}, .radiance = {3}});
  bowl.Arc("moon", {{0.1, -0.6}, 0.12, 0, -kFullTurn}, {.reflectance = {0.6}});
  bowl.Segment("blocker", {0.3, 0.2}, {0.4, 0.5}, {.reflectance = {0.5}});
  ExpectReflectedAgrees(bowl, false);
}

// The horizon of the floor meets the dome's circle at the dome's foot and right across.
TEST(RecordDerivativesTest, DomeWithItsCenterOnTheFloor) {
  SceneMaker dome;
  dome.Segment("floor", {-1, 0}, {1, 0}, {.reflectance = {0.8}}).Probe("floor", 15);
  dome.Arc("dome", {{0.2, 0}, 0.8, 0, 2}, {.reflectance = {0.8}});
  dome.Segment("lamp", {0.1, 0.6}, {-0.1, 0.6}, {.reflectance = {0.8}, .radiance = {1}});
  ExpectReflectedAgrees(dome, false);
}

// Shadows on what reflects make kinks in higher derivatives elsewhere, so here there are none.
TEST(RecordDerivativesTest, HigherOnesOfAllBounces) {
  SceneMaker room;
  room.Segment("floor", {0, 0}, {2, 0}, {.reflectance = {0.7}}).Probe("floor", 7);
  room.Segment("lamp", {1.7, 1.5}, {0.2, 1.3}, {.reflectance = {0.5}, .radiance = {2}});
  room.Arc("hill", {{3, 1}, 0.5, 2, 2}, {.reflectance = {0.6}}).Probe("hill", 5, Side::kBack);
  ExpectReflectedAgrees(room, true);
  SceneMaker bowl;
  bowl.Arc("bowl", {{0, 0}, 1, -2.5, 1.9}, {.reflectance = {0.8}}).Probe("bowl", 7);
  bowl.Segment("lamp", {0.4, 0.6}, {-0.5, 0.5}, {.radiance = {2}});
  ExpectReflectedAgrees(bowl, true);
}

}  // namespace
}  // namespace flatlight
