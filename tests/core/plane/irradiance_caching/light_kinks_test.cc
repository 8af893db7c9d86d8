// SPDX-License-Identifier: Apache-2.0
// Where the light that curves reflect changes its course, against polynomials that are known and shadows whose edges
// are known in closed form; and the events that this makes elsewhere.
#include "core/plane/irradiance_caching/light_kinks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "core/execution/cancellation.h"
#include "core/execution/clock.h"
#include "core/execution/executor.h"
#include "core/plane/irradiance_caching/reflected_series.h"
#include "core/plane/irradiance_caching/skyline.h"
#include "core/plane/irradiance_caching/track.h"
#include "core/plane/irradiance_caching/track_events.h"
#include "core/plane/ray_caster.h"
#include "core/plane/reference/quadrature.h"
#include "core/plane/reference/reference_solver.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

using Function = std::function<double(double)>;

// The function on each panel, in each channel times a factor.
PanelLight LightOf(const PanelMesh& mesh, const Function& function, const std::vector<double>& channels = {1}) {
  PanelLight light(mesh.size(), channels.size(), kLightCoefficients);
  const GaussRule& rule = Gauss(kLightCoefficients);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    for (std::size_t k = 0; k < rule.node.size(); ++k) {
      double p[kLightCoefficients];
      Legendre(rule.node[k], kLightCoefficients, p);
      const double value = function(mesh.panels()[i].At(rule.node[k]));
      for (std::size_t c = 0; c < channels.size(); ++c)
        for (std::size_t n = 0; n < kLightCoefficients; ++n)
          light.Of(i, c)[n] += channels[c] * value * p[n] * rule.weight[k] * (static_cast<double>(n) + 0.5);
    }
  }
  return light;
}

PanelMesh FrontOf(const std::vector<double>& cuts) {
  std::vector<Panel> panels;
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k)
    panels.push_back({ElementId{0}, Side::kFront, cuts[k], cuts[k + 1]});
  return PanelMesh(1, panels);
}

std::size_t CountOn(const LightKinks& kinks, Side side = Side::kFront) { return kinks.Below(ElementId{0}, side, 2); }

const std::vector<double> kCuts = {0, 0.3, 0.4, 0.8, 1};

TEST(LightKinksTest, JumpsOfValueSlopeAndBendAreKinks) {
  const PanelMesh mesh = FrontOf(kCuts);
  for (int power = 0; power <= 2; ++power) {
    for (const double at : {0.3, 0.4, 0.8}) {
      const LightKinks kinks(1, mesh,
                             LightOf(mesh, [&](double u) { return 1 + u + (u < at ? 0 : std::pow(u - at, power)); }));
      EXPECT_EQ(CountOn(kinks), 1u) << power << ' ' << at;
      EXPECT_EQ(kinks.Below(ElementId{0}, Side::kFront, at), 0u) << power << ' ' << at;
      EXPECT_EQ(kinks.Below(ElementId{0}, Side::kFront, at + 1e-8), 1u) << power << ' ' << at;
      EXPECT_EQ(CountOn(kinks, Side::kBack), 0u);
    }
  }
}

TEST(LightKinksTest, SmoothLightHasNone) {
  const PanelMesh mesh = FrontOf(kCuts);
  EXPECT_EQ(CountOn({1, mesh, LightOf(mesh, [](double u) { return 2 + std::sin(u); })}), 0u);
  // Polynomials know light to so many digits, and no kink is seen below them.
  EXPECT_EQ(CountOn({1, mesh, LightOf(mesh, [](double u) { return 1 / (3 - u); })}), 0u);
  EXPECT_EQ(CountOn({1, mesh, LightOf(mesh, [](double) { return 0.0; })}), 0u);
}

// As the shadow of a dim lamp beside a bright one.
TEST(LightKinksTest, WeakKinksCount) {
  const PanelMesh mesh = FrontOf(kCuts);
  for (const double strength : {1e-3, 1e-4, 1e-5}) {
    const LightKinks kinks(
        1, mesh, LightOf(mesh, [&](double u) { return 1 + std::sin(u) + strength * std::max(u - 0.4, 0.0); }));
    EXPECT_EQ(CountOn(kinks), 1u) << strength;
    EXPECT_EQ(kinks.Below(ElementId{0}, Side::kFront, 0.5), 1u) << strength;
  }
}

TEST(LightKinksTest, AnyChannelMayHaveThem) {
  const PanelMesh mesh = FrontOf(kCuts);
  PanelLight light = LightOf(mesh, [](double) { return 1.0; }, {1, 1, 1});
  for (const std::size_t i : {2, 3}) light.Of(i, 2)[0] = 1.1;
  EXPECT_EQ(CountOn({1, mesh, light}), 1u);
}

// Sides and elements are apart, however different their light.
TEST(LightKinksTest, EndsOfElementsAreNone) {
  std::vector<Panel> panels;
  for (const ElementId id : {ElementId{0}, ElementId{1}})
    for (const Side side : {Side::kFront, Side::kBack}) panels.push_back({id, side, 0, 1});
  const PanelMesh mesh(2, panels);
  PanelLight light(4, 1, kLightCoefficients);
  for (std::size_t i = 0; i < 4; ++i) light.Of(i, 0)[0] = static_cast<double>(i);
  const LightKinks kinks(2, mesh, light);
  for (const ElementId id : {ElementId{0}, ElementId{1}})
    for (const Side side : {Side::kFront, Side::kBack}) EXPECT_EQ(kinks.Below(id, side, 2), 0u);
}

// A wall that reflects, and a lamp with a blocker before it: four shadow edges on the wall. A sill between wall and
// floor, black as all else.
struct Shadows {
  static constexpr double kLamp[2] = {1.8, 1.2}, kBlocker[2] = {1.5, 1.0};
  static constexpr Point2 kSill = {1.5, 0.3};  // Its end before the wall.

  explicit Shadows(double dim = 0) {
    SceneMaker maker;
    maker.Segment("floor", {0, 0}, {2, 0}).Probe("floor", 257);
    maker.Segment("wall", {2, 0}, {2, 2}, {.reflectance = {0.5}});
    maker.Segment("lamp", {0.5, kLamp[0]}, {0.5, kLamp[1]}, {.radiance = {dim > 0 ? dim : 1}});
    maker.Segment("blocker", {1.2, kBlocker[0]}, {1.2, kBlocker[1]});
    maker.Segment("sill", {0.9, kSill.y}, kSill);
    // It lights all of the wall.
    if (dim > 0) maker.Segment("bright", {1.9, 2.2}, {1.3, 2.2}, {.radiance = {1}});
    scene = maker.Build();
    caster = std::make_shared<const RayCaster>(scene);
    ReferenceOptions options;
    options.target_error = 1e-9;
    options.channels = 1;
    options.derivatives = 0;
    solver = std::make_unique<ReferenceSolver>(scene, caster, options);
    InlineExecutor executor;
    const SteadyClock clock;
    const Cancellation never;
    while (solver->state() == ReferenceSolver::State::kWorks)
      solver->Advance(executor, 1, never, clock, Clock::Duration::max());
  }

  // Heights on the wall, where lines by an end of the lamp and one of the blocker arrive.
  static std::vector<double> Edges() {
    std::vector<double> edges;
    for (const double lamp : kLamp)
      for (const double blocker : kBlocker) edges.push_back(lamp + (blocker - lamp) * (2 - 0.5) / (1.2 - 0.5));
    std::sort(edges.begin(), edges.end());
    return edges;
  }

  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const RayCaster> caster;
  std::unique_ptr<ReferenceSolver> solver;
};

TEST(LightKinksTest, EdgesOfShadowsAreWhereGeometryPutsThem) {
  const Shadows shadows;
  const LightKinks kinks(shadows.scene->elements().size(), shadows.solver->mesh(), shadows.solver->light());
  for (const double height : Shadows::Edges()) {
    const double u = height / 2;
    EXPECT_EQ(kinks.Below(ElementId{1}, Side::kFront, u - 1e-7) + 1, kinks.Below(ElementId{1}, Side::kFront, u + 1e-7))
        << height;
  }
  EXPECT_EQ(kinks.Below(ElementId{1}, Side::kFront, 2), Shadows::Edges().size());
  EXPECT_EQ(kinks.Below(ElementId{1}, Side::kBack, 2), 0u);
}

// From the floor an edge passes behind the end of the sill where the line by both arrives there: an event, however dim
// the lamp whose shadow it is.
TEST(LightKinksTest, EdgesOfShadowsPassBehindOthers) {
  for (const double dim : {0.0, 0.1, 0.01}) {
    const Shadows shadows(dim);
    const auto charts = ChartsOf(*shadows.scene);
    const ReflectedSeries reflected(*shadows.scene, charts, {&shadows.solver->mesh(), &shadows.solver->light()});
    Skyline skyline(*shadows.caster, charts, true, &reflected);
    const Tracks tracks = TracksOf(*shadows.scene, *shadows.caster);
    const Cancellation never;
    const std::vector<VisibilityEvent> events = EventsBetween(skyline, tracks.tracks[0], tracks.points[0], never);
    int looked_for = 0;
    for (const double height : Shadows::Edges()) {
      const double x = 2 - (2 - Shadows::kSill.x) * height / (height - Shadows::kSill.y);
      if (!(height > Shadows::kSill.y && x > 0.01)) continue;
      ++looked_for;
      const double at = x / shadows.scene->frame().scale;
      double nearest = 1;
      for (const VisibilityEvent& event : events) nearest = std::min(nearest, std::abs(event.at - at));
      EXPECT_LT(nearest, 1e-6) << dim << ' ' << height << ' ' << x;
    }
    EXPECT_EQ(looked_for, 3);
  }
}

}  // namespace
}  // namespace flatlight
