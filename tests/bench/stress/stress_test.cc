// SPDX-License-Identifier: Apache-2.0
// A bounded part of the campaign of numerical stress, and the instruments themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/scene/scene.h"
#include "flatlight/v1/scene.pb.h"
#include "server/convert/scene_convert.h"
#include "tests/bench/stress/brute_force.h"
#include "tests/bench/stress/campaign.h"
#include "tests/bench/stress/known_limits.h"
#include "tests/bench/stress/minimise.h"
#include "tests/bench/stress/physics.h"
#include "tests/bench/stress/random.h"
#include "tests/bench/stress/scene_json.h"
#include "tests/bench/stress/solve.h"
#include "tests/bench/stress/tally.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight::stress {
namespace {

TEST(StressTest, ScenesOfEveryFamilyPassEveryCheck) {
  CampaignOptions options;
  options.scenes = 201;
  options.most_minimised = 0;
  const CampaignResult result = RunCampaign(options);
  EXPECT_GT(result.scenes, 4000u);
  for (const auto& [key, line] : result.lines) {
    EXPECT_TRUE(IsKnown(key.first, key.second, static_cast<double>(line.failures), static_cast<double>(line.scenes)))
        << line.failures << " of " << line.scenes << ": " << key.second << " on scenes of " << key.first
        << ": build/release/bench/stress --family '" << key.first << "' --check '" << key.second
        << "' --scenes 201 minimises and saves them";
  }
  const Pooled &bias = result.tally.biases.at("sampling: all"), &excess = result.tally.excesses.at("sampling: all");
  EXPECT_GT(bias.scenes(), 1000);
  EXPECT_FALSE(bias.IsAbove() || bias.IsBelow()) << bias.Score();
  EXPECT_FALSE(excess.IsAbove()) << excess.Score();
  // Bounds are kept, and are of use: half of the differences come within a tenth of them, and they are not far above.
  EXPECT_GT(result.tally.counts.at("points"), 40'000u);
  EXPECT_LT(result.tally.ratios.at("bound of E / size of terms / 2^-53").Quantile(0.5), 100);
}

class PhysicsTest : public ::testing::TestWithParam<PhysicsCheck> {};

TEST_P(PhysicsTest, Holds) {
  const Failure failure = GetParam().run(1);
  EXPECT_FALSE(failure) << *failure;
}

INSTANTIATE_TEST_SUITE_P(Laws, PhysicsTest, ::testing::ValuesIn(PhysicsChecks()), [](const auto& check) {
  std::string name = check.param.name;
  name.erase(std::remove_if(name.begin(), name.end(), [](char c) { return std::isalnum(c) == 0; }), name.end());
  return name;
});

// What is saved is what was checked.
TEST(StressTest, SavedScenesAreTheScenes) {
  for (const Family& family : Families()) {
    const SceneDescription scene = MakeScene(family, 3, 50);
    Diagnostics diagnostics;
    const auto built = BuildScene(scene, diagnostics);
    v1::Scene proto;
    const auto read = SceneFromJson(SceneJson(scene), proto, diagnostics);
    ASSERT_TRUE(built && read) << family.name << ": " << diagnostics.kept()[0].path << diagnostics.kept()[0].message;
    EXPECT_EQ(read->world_hash(), built->world_hash()) << family.name;
    EXPECT_EQ(read->probe_hash(), built->probe_hash()) << family.name;
  }
}

TEST(StressTest, AFailingSceneShrinksToWhatFails) {
  const SceneDescription scene = MakeScene(Families()[0], 1, 17);
  ASSERT_GT(scene.curves.size(), 3u);
  const std::string name = scene.curves[2].name;
  const SceneDescription small = Minimised(scene, [&](const SceneDescription& candidate) {
    return std::any_of(candidate.curves.begin(), candidate.curves.end(),
                       [&](const CurveDescription& curve) { return curve.name == name; });
  });
  EXPECT_EQ(small.curves.size(), 1u);
  EXPECT_TRUE(small.probes.empty());
  EXPECT_TRUE(std::holds_alternative<SegmentDescription>(small.curves[0].shape));
  EXPECT_FALSE(small.curves[0].emission);
}

// What is far below the noise of one scene adds up. Terms are skewed, as those of samples that miss light are.
TEST(StressTest, AnErrorFarBelowTheNoiseOfASceneShowsInThePool) {
  Random random(5);
  Pooled honest, dim;
  for (int scene = 0; scene < 50'000; ++scene) {
    // With mean 0 and deviation 1: rarely much, as a rule too little.
    const double term = random.Chance(0.02) ? 7 : -1.0 / 7;
    honest.Add(term), dim.Add(term - 0.03);
    EXPECT_TRUE(scene > 500 || !dim.IsBelow());  // Too few to tell.
  }
  EXPECT_FALSE(honest.IsAbove() || honest.IsBelow()) << honest.Score();
  EXPECT_TRUE(dim.IsBelow()) << dim.Score();
  EXPECT_FALSE(dim.IsAbove());
}

// Where the order of curves does change the light, and no name warns of it, the check has to see it.
TEST(StressTest, AChangeOfLightIsNoticed) {
  SceneMaker maker;
  maker.Segment("c0", {1, 1}, {-1, 1}, {.radiance = {1}});
  maker.Segment("c1", {-1, 1}, {1, 1});
  maker.PointProbe({0, 0}, {0, 1});
  int noticed = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Tally tally;
    noticed += CheckOrder(maker.description(), seed, tally) ? 1 : 0;
  }
  EXPECT_GT(noticed, 0);
  EXPECT_LT(noticed, 8);  // Some orders are the old one.
}

TEST(StressTest, RaysGiveClosedForms) {
  SceneMaker maker = UnitLight();
  maker.Segment("blocker", {0.5, 0.5}, {1.2, 0.5});
  maker.PointProbe({0.3, 0}, {0, 1});
  const Built built(maker.description());
  const BruteIrradiance light = IrradianceByRays(*built.scene, *built.points[0]);
  EXPECT_NEAR(light.value, 0.3 / std::hypot(0.3, 1) + 0.4 / std::hypot(0.4, 1), 1e-14);
  EXPECT_LT(light.uncertain, 1e-13);
  // A point that is known to 1e-6 only.
  EXPECT_GT(IrradianceByRays(*built.scene, *built.points[0], {.position = 1e-6}).uncertain, 1e-6);
}

}  // namespace
}  // namespace flatlight::stress
