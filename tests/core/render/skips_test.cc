// SPDX-License-Identifier: Apache-2.0
#include "core/render/skips.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "core/render/plan.h"
#include "tests/support/transport/render.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

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
  Settings exact_value = exact;
  exact_value.derivatives = Derivatives::kNone;
  SceneMaker dark;
  dark.Segment("floor", {0, 0}, {1, 0}, {.reflectance = {0.5}}).Probe("floor", 3);
  SceneMaker black = UnitLight();
  black.Segment("blocker", {0.5, 0.5}, {1.2, 0.5}).Probe("floor", 5);
  SceneMaker partly_black = black;
  partly_black.Segment("wall", {1.5, 0}, {1.5, 1}, {.reflectance = {0.8}});
  SceneMaker turned = black;
  turned.Segment("turned", {0, 2}, {1, 2}, {.radiance = {1}}).Segment("below", {0, -1}, {1, -1}, {.radiance = {2}});
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
      {"no derivatives", grey.Build(), exact_value, skip::kDerivatives},
      {"black", black.Build(), Sampled(64), skip::kBounces},
      {"black paths", black.Build(), Sampled(64), skip::kBlackPaths},
      {"partly black", partly_black.Build(), Sampled(64), skip::kBlackPaths},
      {"turned away", turned.Build(), direct, skip::kUnseenEmitters},
      {"converged", convex.Build(), target, skip::kConvergedPoints},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const Plan plan = PlanFor(*c.scene, c.settings);
    EXPECT_TRUE(plan.Takes(c.skip));
    Settings disabled = c.settings;
    disabled.no_skip = {c.skip};
    EXPECT_TRUE(PlanFor(*c.scene, disabled).Disables(c.skip));
    const Ended with = Render(c.scene, c.settings);
    const Ended without = Render(c.scene, disabled);
    ASSERT_EQ(with.field->probes.size(), without.field->probes.size());
    for (std::size_t p = 0; p < with.field->probes.size(); ++p) {
      EXPECT_EQ(with.field->probes[p].irradiance, without.field->probes[p].irradiance);
      EXPECT_EQ(with.field->probes[p].gradient, without.field->probes[p].gradient);
      EXPECT_EQ(with.field->probes[p].samples, without.field->probes[p].samples);
      EXPECT_EQ(with.field->probes[p].standard_error, without.field->probes[p].standard_error);
    }
    if (c.skip == skip::kConvergedPoints || c.skip == skip::kVisibility || c.skip == skip::kBounces) {
      EXPECT_LE(with.field->rays, without.field->rays);
    }
  }
}

}  // namespace
}  // namespace flatlight
