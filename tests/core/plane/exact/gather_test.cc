// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/gather.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "core/plane/exact/sweep.h"
#include "core/scene/scene.h"
#include "tests/core/plane/exact/test_scenes.h"

namespace flatlight {
namespace {

// What can be seen does not depend on what is left out because it is hidden.
TEST(GatherTest, TheSweepOverEverythingGivesTheSame) {
  std::mt19937_64 random(11);
  int compared = 0;
  for (int round = 0; round < 60; ++round) {
    SceneDescription description = EmptyScene();
    for (int i = 0; i < 60; ++i) {
      const Point2 a = RandomPoint(random);
      if (round % 2 == 0 && i % 3 == 0) {
        AddCurve(description, ArcDescription{a, Uniform(random, 0.02, 0.2), 0.3, Uniform(random, 1, 6)});
      } else {
        AddCurve(description,
                 SegmentDescription{a, a + Vector2{Uniform(random, -0.3, 0.3), Uniform(random, -0.3, 0.3)}});
      }
    }
    ProbeDescription free;
    free.name = "free";
    for (int i = 0; i < 20; ++i) free.points.push_back({RandomPoint(random), RandomPoint(random) - Point2{}});
    description.probes.push_back(free);
    const auto scene = Build(description);
    const Bvh bvh(*scene);
    Gatherer gatherer(*scene, bvh);
    Sweep sweep(*scene);
    for (const Receiver& receiver : scene->probes()[0].receivers) {
      std::vector<Part> parts;
      for (std::size_t e = 0; e < scene->elements().size(); ++e) {
        const Parts of_element = PartsOf(*scene, static_cast<ElementId>(e), receiver);
        parts.insert(parts.end(), of_element.part, of_element.part + of_element.count);
      }
      // By key, the element seen from there on.
      using Views = std::vector<std::pair<double, std::int64_t>>;
      Views expected, found;
      const auto add = [](Views& views, double key, std::int64_t element) {
        if (!views.empty() && key - views.back().first < 1e-13) views.pop_back();  // Of no width.
        if (views.empty() ? element >= 0 : views.back().second != element) views.emplace_back(key, element);
      };
      for (const VisibleInterval& interval : sweep.Run(parts, receiver)) {
        add(expected, interval.begin.key,
            interval.part < 0 ? -1 : static_cast<std::int64_t>(parts[static_cast<std::size_t>(interval.part)].element));
      }
      const Envelope& envelope = gatherer.Gather(receiver);
      if (envelope.doubtful()) continue;
      ++compared;
      for (std::size_t i = 0; i <= envelope.sectors().size(); ++i) {
        const Sector& sector = envelope.sectors()[i];
        add(found, sector.key, sector.sight < 0 ? -1 : static_cast<std::int64_t>(envelope.SightOf(sector).element));
      }
      ASSERT_EQ(found.size(), expected.size()) << round;
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].second, expected[i].second) << round;
        EXPECT_NEAR(found[i].first, expected[i].first, 1e-12) << round;
      }
    }
  }
  EXPECT_GT(compared, 1100);
}

TEST(GatherTest, SameBitsOnEveryVectorUnit) {
  std::mt19937_64 random(12);
  SceneDescription description = EmptyScene();
  for (int i = 0; i < 300; ++i) AddRandomCurve(description, random, true);
  ProbeDescription free;
  free.name = "free";
  for (int i = 0; i < 100; ++i) free.points.push_back({RandomPoint(random), RandomPoint(random) - Point2{}});
  description.probes.push_back(free);
  const auto scene = Build(description);
  const std::vector<WorldValue> best = Solve(*scene, 0);
  const std::int64_t all = hwy::SupportedTargets();
  for (std::int64_t rest = all; rest != 0; rest &= rest - 1) {
    hwy::SetSupportedTargetsForTest(rest & -rest);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    const std::vector<WorldValue> values = Solve(*scene, 0);
    for (std::size_t i = 0; i < best.size(); ++i) {
      EXPECT_EQ(values[i].irradiance, best[i].irradiance) << hwy::TargetName(rest & -rest);
      EXPECT_EQ(values[i].hessian, best[i].hessian) << hwy::TargetName(rest & -rest);
      EXPECT_EQ(values[i].hessian_error, best[i].hessian_error) << hwy::TargetName(rest & -rest);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

// Seen from so far away that single precision tells nothing apart.
TEST(GatherTest, FarAwayPointsSeeTheScene) {
  for (const double distance : {1e3, 1e6, 1e9, 1e12}) {
    SceneDescription scene = EmptyScene();
    AddCurve(scene, SegmentDescription{{1, 0}, {-1, 0}}, 1);
    AddCurve(scene, SegmentDescription{{-1, -1}, {0, -1}});
    const WorldValue value = Solve(*Build(WithFreePoint(scene, {0, -distance})), 0)[0];
    EXPECT_NEAR(value.irradiance * distance, 1, value.irradiance_error * distance + 2 / distance) << distance;
    EXPECT_GT(value.irradiance, 0) << distance;
  }
}

}  // namespace
}  // namespace flatlight
