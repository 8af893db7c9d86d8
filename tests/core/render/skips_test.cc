// SPDX-License-Identifier: Apache-2.0
#include "core/render/skips.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/render/plan.h"
#include "tests/support/transport/render.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

void ExpectSameBits(const Field& a, const Field& b) {
  ASSERT_EQ(a.probes.size(), b.probes.size());
  for (std::size_t p = 0; p < a.probes.size(); ++p) {
    EXPECT_EQ(a.probes[p].irradiance, b.probes[p].irradiance);
    EXPECT_EQ(a.probes[p].gradient, b.probes[p].gradient);
    EXPECT_EQ(a.probes[p].gradient_error, b.probes[p].gradient_error);
    EXPECT_EQ(a.probes[p].hessian, b.probes[p].hessian);
    EXPECT_EQ(a.probes[p].hessian_error, b.probes[p].hessian_error);
    EXPECT_EQ(a.probes[p].rotation_gradient, b.probes[p].rotation_gradient);
    EXPECT_EQ(a.probes[p].samples, b.probes[p].samples);
    EXPECT_EQ(a.probes[p].standard_error, b.probes[p].standard_error);
  }
}

TEST(SkipsTest, EverySkipLeavesTheSameBits) {
  struct Case {
    std::string name;
    std::shared_ptr<const Scene> scene;
    Settings settings;
    const char* skip;
  };
  Settings target = Sampled(4096);
  target.target_error = 0.05;
  Settings direct = Sampled(128);
  direct.max_bounces = 0;
  Settings exact;
  exact.max_bounces = 0;
  SceneMaker dark;
  dark.Segment("floor", {0, 0}, {1, 0}, {.reflectance = {0.5}}).Probe("floor", 3);
  SceneMaker black = UnitLight();
  black.Segment("blocker", {0.5, 0.5}, {1.2, 0.5}).Probe("floor", 5);
  SceneMaker partly_black = black;
  partly_black.Segment("wall", {1.5, 0}, {1.5, 1}, {.reflectance = {0.8}});
  SceneMaker turned = black;
  turned.Segment("turned", {0, 2}, {1, 2}, {.radiance = {1}}).Segment("below", {0, -1}, {1, -1}, {.radiance = {2}});
  SceneMaker white_lamp;
  white_lamp.Segment("floor", {0, 0}, {1, 0}).Segment("blocker", {0.5, 0.5}, {1.2, 0.5}).Probe("floor", 5);
  white_lamp.Segment("lamp", {1, 1}, {0, 1}, {.reflectance = {0.9}, .radiance = {1}});
  SceneMaker beside_post = FurnishedRoom(true, 5);
  SceneMaker round_room;
  round_room.Arc("room", {{0, 0}, 1, 0, 6.283185307179586}, {.reflectance = {0.6}}).Probe("room", 8);
  round_room.Arc("sun", {{0.3, 0.2}, 0.2, 0, -6.283185307179586}, {.reflectance = {0.2}, .radiance = {2}});
  round_room.Arc("moon", {{-0.4, -0.3}, 0.1, 0, -6.283185307179586}, {.reflectance = {0.5}}).Probe("moon", 5);
  SceneMaker turned_room = black;
  turned_room.Segment("wall", {1.5, 0}, {1.5, 1}, {.reflectance = {0.8}});
  turned_room.Segment("turned", {0, 2}, {1, 2}, {.radiance = {1}});
  SceneMaker screened = turned_room;
  screened.Segment("far lamp", {1, 9}, {0, 9}, {.radiance = {5}}).Segment("screen", {-9, 3}, {9, 3});
  SceneMaker grey = FurnishedRoom(true, 3);
  SceneMaker grey3 = UnitLight();
  grey3.Segment("wall", {1.5, 0}, {1.5, 1}, {.reflectance = {0.5, 0.5, 0.5}}).Probe("floor", 3);
  SceneMaker convex = SquareRoom({.reflectance = {0.5}, .radiance = {1}}, 3);
  SceneMaker facing = UnitLight();
  facing.Probe("floor", 5).Probe("light", 2);
  const std::vector<Case> cases = {
      {"dark", dark.Build(), Sampled(64), skip::kEmission},
      {"dark exact", dark.Build(), exact, skip::kEmission},
      {"grey", grey.Build(), Sampled(64), skip::kColour},
      {"grey with 3 channels", grey3.Build(), Sampled(64), skip::kColour},
      {"grey exact", grey.Build(), exact, skip::kColour},
      {"convex", convex.Build(), Sampled(64), skip::kVisibility},
      {"facing", facing.Build(), direct, skip::kVisibility},
      {"facing exact", facing.Build(), exact, skip::kVisibility},
      {"black", black.Build(), Sampled(64), skip::kBounces},
      {"white lamp over black", white_lamp.Build(), Sampled(64), skip::kBounces},
      {"partly black", partly_black.Build(), Sampled(64), skip::kBlackPaths},
      {"clear of the post", beside_post.Build(), Sampled(64), skip::kVisibility},
      {"clear of the post, direct", beside_post.Build(), direct, skip::kVisibility},
      {"round room", round_room.Build(), Sampled(64), skip::kVisibility},
      {"turned away", turned.Build(), direct, skip::kUnseenEmitters},
      {"turned away from walls", turned_room.Build(), Sampled(64), skip::kUnseenEmitters},
      {"behind a screen", screened.Build(), Sampled(64), skip::kUnseenEmitters},
      {"converged", convex.Build(), target, skip::kConvergedPoints},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const Plan plan = PlanFor(*c.scene, c.settings);
    ASSERT_TRUE(plan.Takes(c.skip));
    Settings disabled = c.settings;
    disabled.no_skip = {c.skip};
    EXPECT_TRUE(PlanFor(*c.scene, disabled).Disables(c.skip));
    const Ended with = Render(c.scene, c.settings);
    const Ended without = Render(c.scene, disabled);
    ExpectSameBits(*with.field, *without.field);
    if (c.skip == skip::kConvergedPoints || c.skip == skip::kVisibility || c.skip == skip::kBounces) {
      EXPECT_LE(with.field->rays, without.field->rays);
    }
  }
}

// Convex rooms of dark and shining walls of any length: lamps beside each other, apart, and behind a receiver.
TEST(SkipsTest, RoomsWhereNothingBlocksKeepTheirBitsInClosedForm) {
  Settings exact;
  exact.method = Method::kExact;
  exact.max_bounces = 0;
  Settings thorough = exact;
  thorough.no_skip = {skip::kVisibility};
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    const int walls = 3 + static_cast<int>(20 * unit(random));
    std::vector<double> angles;
    angles.reserve(static_cast<std::size_t>(walls));
    for (int i = 0; i < walls; ++i) angles.push_back(6.283 * unit(random));
    std::sort(angles.begin(), angles.end());
    SceneMaker maker;
    for (std::size_t i = 0; i < angles.size(); ++i) {
      const double a = angles[i], b = angles[(i + 1) % angles.size()];
      Look look;
      if (unit(random) < 0.7) look.radiance = {0.1 + unit(random)};
      maker.Segment("wall " + std::to_string(i), {std::cos(a), 0.7 * std::sin(a)}, {std::cos(b), 0.7 * std::sin(b)},
                    look);
      maker.Probe("wall " + std::to_string(i), 3);
    }
    const std::shared_ptr<const Scene> scene = maker.Build();
    if (scene->traits().emitting_curves == 0) continue;
    ASSERT_TRUE(PlanFor(*scene, exact).Takes(skip::kVisibility));
    ExpectSameBits(*Render(scene, exact).field, *Render(scene, thorough).field);
  }
}

// Walls, lamps and arcs thrown about, some of them black: every skip that any of them takes, by either method.
TEST(SkipsTest, RandomScenesKeepTheirBits) {
  std::map<std::string, int> taken;
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-1, 1);
    std::uniform_real_distribution<double> unit(0, 1);
    SceneMaker maker;
    const int curves = 2 + static_cast<int>(6 * unit(random));
    for (int i = 0; i < curves; ++i) {
      const std::string name = "curve " + std::to_string(i);
      Look look{.reflectance = {unit(random) < 0.6 ? 0.0 : unit(random)}};
      if (unit(random) < 0.4) look.radiance = {unit(random)}, look.two_sided = unit(random) < 0.2;
      const Point2 a{place(random), place(random)};
      if (unit(random) < 0.7) {
        maker.Segment(name, a, a + Vector2{place(random), place(random)}, look);
      } else {
        const double sweep = unit(random) < 0.5 ? 6.283185307179586 : 0.3 + 3 * unit(random);
        maker.Arc(name, {a, 0.1 + 0.9 * unit(random), 6 * unit(random), unit(random) < 0.5 ? sweep : -sweep}, look);
      }
    }
    maker.Probe("curve 0", 3, unit(random) < 0.5 ? Side::kFront : Side::kBack);
    if (unit(random) < 0.5) maker.PointProbe({place(random), place(random)}, {place(random), place(random)});
    const std::shared_ptr<const Scene> scene = maker.Build();
    Settings direct = Sampled(32);
    direct.max_bounces = 0;
    Settings exact;
    exact.method = Method::kExact;
    exact.max_bounces = 0;
    for (const Settings& settings : {Sampled(32), direct, exact}) {
      const Ended with = Render(scene, settings);
      for (const SkipEntry& entry : PlanFor(*scene, settings).skips) {
        if (entry.decision != SkipDecision::kTaken) continue;
        SCOPED_TRACE(entry.name);
        ++taken[entry.name];
        Settings disabled = settings;
        disabled.no_skip = {entry.name};
        ExpectSameBits(*with.field, *Render(scene, disabled).field);
      }
    }
  }
  for (const char* name :
       {skip::kEmission, skip::kVisibility, skip::kBounces, skip::kBlackPaths, skip::kUnseenEmitters})
    EXPECT_GT(taken[name], 8) << name;
}

}  // namespace
}  // namespace flatlight
