// SPDX-License-Identifier: Apache-2.0
#include "core/render/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/render/skips.h"
#include "tests/support/transport/mistakes.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::shared_ptr<const Scene> Black() { return UnitLight().Probe("floor", 5).Build(); }
std::shared_ptr<const Scene> Reflecting() { return FurnishedRoom(true, 5).Build(); }

// "path: message" of every mistake.
Plan PlanFor(const Scene& scene, const Settings& settings = {}) {
  Diagnostics diagnostics;
  return MakePlan(scene, settings, diagnostics).value();
}

TEST(PlanTest, DefaultMethodFollowsTheScene) {
  EXPECT_EQ(PlanFor(*Black()).settings.method, Method::kExact);
  EXPECT_EQ(PlanFor(*Reflecting()).settings.method, Method::kPathTracing);
  Settings direct;
  direct.max_bounces = 0;
  EXPECT_EQ(PlanFor(*Reflecting(), direct).settings.method, Method::kExact);
  Settings bounces;
  bounces.max_bounces = 3;
  EXPECT_EQ(PlanFor(*Reflecting(), bounces).settings.method, Method::kPathTracing);
  EXPECT_EQ(PlanFor(*Black(), bounces).settings.method, Method::kExact) << "nothing reflects: three bounces or none";
}

TEST(PlanTest, FillsInDefaults) {
  const Settings exact = PlanFor(*Black()).settings;
  EXPECT_EQ(exact.derivatives, Derivatives::kHessian);
  EXPECT_FALSE(exact.samples.has_value());
  const Settings paths = PlanFor(*Reflecting()).settings;
  EXPECT_EQ(paths.samples, 1024u);
  EXPECT_EQ(paths.seed, 0u);
  EXPECT_EQ(paths.derivatives, Derivatives::kNone);
  Settings target;
  target.target_error = 0.01;
  EXPECT_FALSE(PlanFor(*Reflecting(), target).settings.samples.has_value());
  target.samples = 100;
  EXPECT_EQ(PlanFor(*Reflecting(), target).settings.samples, 100u);
  Settings limit;
  limit.time_limit = 2;
  EXPECT_FALSE(PlanFor(*Reflecting(), limit).settings.samples.has_value());
}

TEST(PlanTest, RayTracingGivesDerivatives) {
  Settings settings;
  settings.method = Method::kRayTracing;
  const Plan plan = PlanFor(*Reflecting(), settings);
  EXPECT_EQ(plan.settings.samples, 256u);
  EXPECT_EQ(plan.settings.derivatives, Derivatives::kGradient);
  EXPECT_EQ(plan.settings.formulation, Formulation::kStratified);
  EXPECT_GT(plan.passes[0].expected_rays, 256 * plan.passes[0].points);
  EXPECT_THAT(plan.summary, testing::StartsWith("Ray tracing of all bounces and its gradient at "));
  EXPECT_EQ(PlanFor(*Black(), settings).settings.derivatives, Derivatives::kHessian);
  settings.derivatives = Derivatives::kHessian;
  EXPECT_THAT(Mistakes(*Reflecting(), settings), ElementsAre(HasSubstr("gives the Hessian of direct light alone")));
  settings.max_bounces = 0;
  EXPECT_THAT(Mistakes(*Reflecting(), settings), testing::IsEmpty());
  settings.max_bounces.reset();
  settings.derivatives = Derivatives::kNone;
  EXPECT_FALSE(PlanFor(*Reflecting(), settings).settings.formulation.has_value());
}

TEST(PlanTest, AFormulationThatWouldBeIgnoredIsAMistake) {
  Settings settings;
  settings.formulation = Formulation::kPolyline;
  settings.method = Method::kPathTracing;
  EXPECT_THAT(Mistakes(*Reflecting(), settings),
              ElementsAre(HasSubstr("settings.formulation: applies to ray-tracing alone")));
  settings.method = Method::kRayTracing;
  EXPECT_THAT(Mistakes(*Reflecting(), settings), testing::IsEmpty());
  settings.derivatives = Derivatives::kNone;
  EXPECT_THAT(Mistakes(*Reflecting(), settings), ElementsAre(HasSubstr("derivatives none asks for none")));
}

TEST(PlanTest, ReportsEveryMistakeWithItsPlace) {
  Settings settings;
  settings.method = Method::kPathTracing;
  settings.samples = 0;
  settings.threads = 0;
  settings.target_error = 1.5;
  settings.time_limit = -2;
  settings.derivatives = Derivatives::kGradient;
  settings.no_skip = {"colour", "everything"};
  EXPECT_THAT(Mistakes(*Reflecting(), settings),
              ElementsAre("settings.samples: is 0, must be at least 1", "settings.threads: is 0, must be at least 1",
                          "settings.targetError: is 1.5, must be in (0, 1]",
                          "settings.timeLimit: is -2 s, must be a number above 0",
                          testing::AllOf(HasSubstr("settings.noSkip[1]: \"everything\""), HasSubstr("black-paths")),
                          testing::AllOf(HasSubstr("settings.derivatives"), HasSubstr("exact"))));
}

TEST(PlanTest, RefusesNumbersThatAreNone) {
  for (const double bad : {0.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    Settings settings;
    settings.target_error = bad;
    settings.time_limit = bad;
    EXPECT_EQ(Mistakes(*Reflecting(), settings).size(), 2u) << bad;
  }
}

TEST(PlanTest, ExactRefusesWhatItWouldIgnore) {
  Settings settings;
  settings.method = Method::kExact;
  settings.samples = 64;
  settings.seed = 1;
  settings.target_error = 0.1;
  settings.time_limit = 1;
  EXPECT_THAT(Mistakes(*Black(), settings),
              ElementsAre(HasSubstr("settings.samples: does not apply to exact"), HasSubstr("settings.seed: does not"),
                          HasSubstr("settings.targetError: does not"), HasSubstr("settings.timeLimit: does not")));
}

// A setting about samples asks for sampling, also where exact would be the default.
TEST(PlanTest, SettingsAboutSamplesChooseSampling) {
  const auto method = [](auto set) {
    Settings settings;
    set(settings);
    Diagnostics diagnostics;
    return MakePlan(*Black(), settings, diagnostics)->settings.method;
  };
  EXPECT_EQ(method([](Settings&) {}), Method::kExact);
  EXPECT_EQ(method([](Settings& s) { s.samples = 64; }), Method::kPathTracing);
  EXPECT_EQ(method([](Settings& s) { s.seed = 1; }), Method::kPathTracing);
  EXPECT_EQ(method([](Settings& s) { s.target_error = 0.1; }), Method::kPathTracing);
  EXPECT_EQ(method([](Settings& s) { s.time_limit = 1; }), Method::kPathTracing);
}

TEST(PlanTest, ExactRefusesReflections) {
  Settings settings;
  settings.method = Method::kExact;
  EXPECT_THAT(
      Mistakes(*Reflecting(), settings),
      ElementsAre("settings.method: exact gives direct light, and this scene reflects: set max bounces to 0, or "
                  "use reference or path-tracing"));
  settings.max_bounces = 2;
  EXPECT_THAT(Mistakes(*Reflecting(), settings), ElementsAre(HasSubstr("settings.maxBounces: is 2")));
  settings.max_bounces = 0;
  EXPECT_THAT(Mistakes(*Reflecting(), settings), IsEmpty());
}

TEST(PlanTest, RefusesLightThatNeverFades) {
  const auto room = SquareRoom({.reflectance = {1}, .radiance = {1}}, 1).Build();
  Settings settings;
  settings.method = Method::kPathTracing;
  EXPECT_THAT(Mistakes(*room, settings), ElementsAre(HasSubstr("light never fades")));
  settings.max_bounces = 5;
  EXPECT_THAT(Mistakes(*room, settings), IsEmpty());
  // An open scene lets light out.
  SceneMaker open;
  open.Segment("floor", {0, 0}, {1, 0}, {.reflectance = {1}}).Probe("floor", 1);
  open.Segment("light", {1, 1}, {0, 1}, {.reflectance = {1}, .radiance = {1}});
  EXPECT_THAT(Mistakes(*open.Build(), {}), IsEmpty());
}

TEST(PlanTest, EverySkipHasADecisionAndAReason) {
  for (const auto& scene : {Black(), Reflecting()}) {
    const Plan plan = PlanFor(*scene);
    std::vector<std::string> names;
    for (const SkipEntry& entry : plan.skips) {
      names.push_back(entry.name);
      EXPECT_FALSE(entry.reason.empty()) << entry.name;
    }
    EXPECT_EQ(names, SkipNames());
  }
}

TEST(PlanTest, CachingSaysThatItLeavesOutLightOverMirrors) {
  SceneMaker maker;
  maker.Segment("floor", {0, 0}, {1, 0}).Probe("floor", 3);
  maker.Segment("mirror", {0, 0}, {0, 1}, {.material = MirrorDescription{{0.9}}});
  maker.Light(PointLightDescription{{0.5, 0.5}, {1}});
  const auto scene = maker.Build();
  Settings settings;
  for (const Method method : {Method::kPathTracing, Method::kRayTracing}) {
    settings.method = method;
    EXPECT_THAT(Mistakes(*scene, settings), IsEmpty());
  }
  settings.method = Method::kIrradianceCaching;
  EXPECT_THAT(Mistakes(*scene, settings), ElementsAre(HasSubstr("use path-tracing or ray-tracing")));
  settings.max_bounces = 0;
  EXPECT_THAT(Mistakes(*scene, settings), IsEmpty());
}

TEST(PlanTest, SkipsCanBeSwitchedOff) {
  Settings settings;
  settings.no_skip = {skip::kColour};
  const Plan plan = PlanFor(*Reflecting(), settings);
  EXPECT_FALSE(plan.Takes(skip::kColour));
  EXPECT_TRUE(plan.Disables(skip::kColour));
  // What doesn't apply isn't disabled either.
  EXPECT_FALSE(PlanFor(*FurnishedRoom(false, 1).Build(), settings).Disables(skip::kColour));
}

TEST(PlanTest, VisibilityIsSkippedOnlyWhereNothingCanBlock) {
  const auto takes = [](const SceneMaker& maker) { return PlanFor(*maker.Build()).Takes(skip::kVisibility); };
  const SceneMaker facing = UnitLight().Probe("floor", 2);
  EXPECT_TRUE(takes(facing));
  EXPECT_TRUE(takes(SquareRoom({.reflectance = {0.5}, .radiance = {1}}, 1)));
  EXPECT_FALSE(takes(SceneMaker(facing).Segment("blocker", {0.2, 0.5}, {0.4, 0.5})));
  EXPECT_FALSE(takes(SceneMaker(facing).Segment("standing", {0.5, 0}, {0.5, 0.1})));
  EXPECT_FALSE(takes(SceneMaker(facing).PointProbe({0.5, -1}, {0, 1}))) << "the floor stands before the light";
  EXPECT_TRUE(takes(SceneMaker(facing).PointProbe({0.5, 0.5}, {0, 1})));
  EXPECT_FALSE(takes(SceneMaker(facing).Arc("disc", {{5, 5}, 0.1, 0, 6.283185307179586})));
}

TEST(PlanTest, ForecastsRays) {
  Settings settings;
  settings.samples = 100;
  const Plan plan = PlanFor(*Reflecting(), settings);
  ASSERT_EQ(plan.passes.size(), 1u);
  EXPECT_EQ(plan.passes[0].points, 20);
  EXPECT_EQ(plan.passes[0].samples, 112);
  EXPECT_GT(plan.passes[0].expected_rays, 20 * 112 * 2);
  EXPECT_EQ(PlanFor(*Black()).passes[0].expected_rays, 0);
}

TEST(PlanTest, SummarySaysWhatWillBeDone) {
  EXPECT_EQ(PlanFor(*Black()).summary, "Exact direct light with gradient and Hessian at 5 points.");
  EXPECT_EQ(PlanFor(*Reflecting()).summary, "Path tracing of all bounces at 20 points, 1024 paths each.");
  Settings settings;
  settings.max_bounces = 1;
  settings.samples = 64;
  settings.target_error = 0.01;
  settings.time_limit = 5;
  EXPECT_EQ(PlanFor(*Reflecting(), settings).summary,
            "Path tracing of up to 1 bounce at 20 points, at most 64 paths each, until the error is 1 %, for 5 s.");
}

TEST(PlanTest, SummarySaysWhereExactWouldDo) {
  const std::string exact = "; the method exact would be done sooner, with no error but rounding.";
  const auto summary = [](const Scene& scene, Method method, std::optional<bool> gather = {}) {
    Settings settings;
    settings.method = method;
    settings.final_gather = gather;
    return PlanFor(scene, settings).summary;
  };
  EXPECT_THAT(summary(*Black(), Method::kIrradianceCaching), testing::EndsWith(exact));
  EXPECT_THAT(summary(*Black(), Method::kPhotonMapping, false), testing::EndsWith(exact));
  for (const Method method : {Method::kIrradianceCaching, Method::kPhotonMapping})
    EXPECT_THAT(summary(*Reflecting(), method), testing::Not(testing::HasSubstr("exact")));
  EXPECT_THAT(summary(*Black(), Method::kPhotonMapping, true), testing::EndsWith(", all of it in closed form."));
}

TEST(PlanTest, TrianglesWhereTheyPay) {
  const auto rows = [](int curves, std::uint32_t points, bool arc = false) {
    SceneMaker maker;
    for (int i = 0; i < curves; ++i)
      maker.Segment("s" + std::to_string(i), {0, 0.1 * i}, {1, 0.1 * i + 0.01}, {.radiance = {1}});
    if (arc) maker.Arc("arc", {{2, 0}, 0.5, 0, 1});
    return maker.Probe("s0", points).Build();
  };
  EXPECT_TRUE(PlanFor(*rows(8, 4)).triangles);
  EXPECT_EQ(PlanFor(*rows(8, 4)).passes[0].name,
            "direct light in closed form, through triangles where they can be made");
  EXPECT_FALSE(PlanFor(*rows(8, 3)).triangles) << "too few points";
  EXPECT_EQ(PlanFor(*rows(8, 3)).passes[0].name, "direct light in closed form");
  EXPECT_FALSE(PlanFor(*rows(8, 80, true)).triangles) << "arcs";
  EXPECT_FALSE(PlanFor(*Black()).triangles) << "nothing blocks";
  Settings sampled;
  sampled.method = Method::kPathTracing;
  EXPECT_FALSE(PlanFor(*rows(8, 4), sampled).triangles);
}

}  // namespace
}  // namespace flatlight
