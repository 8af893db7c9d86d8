// SPDX-License-Identifier: Apache-2.0
// Chances of choosing emitters, by trying them out: those that are told must be those that are taken.
#include "core/plane/path_tracing/emitter_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/plane/path_tracing/emitter_range.h"
#include "core/plane/path_tracing/emitter_tree.h"
#include "core/plane/ray_caster.h"
#include "core/scene/element_frame.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

EmitterTree RandomTree(std::mt19937_64& random, std::size_t count) {
  std::uniform_real_distribution<double> place(-1, 1);
  std::vector<EmitterTree::Emitter> emitters;
  for (std::size_t i = 0; i < count; ++i) {
    const Point2 low{place(random), place(random)};
    const double size = 0.05 * (1 + place(random));
    const double power = std::exp(4 * place(random));
    const Vector2 facing = Normalized(Vector2{place(random), 0.1 + place(random)});
    emitters.push_back({low, low + Vector2{size, 0.02}, power, 0.9 * power * facing});
  }
  return EmitterTree(emitters);
}

// 4096 evenly spread numbers choose each leaf as often as its chance says, to within two numbers for each step of the
// walk; the chances of all leaves make 1, but for clusters of nothing; what is left of the numbers is spread evenly.
TEST(EmitterTreeTest, TellsTheChancesItTakes) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(-1, 1);
  int whole = 0;
  for (const std::size_t count : {1u, 4u, 5u, 37u, 300u}) {
    const EmitterTree tree = RandomTree(random, count);
    std::vector<std::uint32_t> order = tree.order();
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(order[i], i);
    for (int k = 0; k < 20; ++k) {
      const Vertex vertex{{{place(random), place(random)}, ElementId::kNone}, Normalized(Vector2{place(random), 0.2})};
      constexpr int kNumbers = 4096;
      std::map<std::uint32_t, int> taken;
      double rest = 0;
      double chosen = 0;
      for (int i = 0; i < kNumbers; ++i) {
        const EmitterTree::Leaf leaf = tree.Choose(vertex, (i + 0.5) / kNumbers);
        if (leaf.count == 0) continue;
        ++taken[leaf.first];
        rest += leaf.rest / kNumbers;
        chosen += 1.0 / kNumbers;
        EXPECT_GE(leaf.rest, 0);
        EXPECT_LE(leaf.rest, 1);
      }
      double sum = 0;
      for (std::uint32_t i = 0; i < count;) {
        const EmitterTree::Leaf leaf = tree.Find(vertex, i);
        if (leaf.count == 0) {
          ++i;
          continue;
        }
        EXPECT_EQ(leaf.first, i);
        EXPECT_NEAR(taken[leaf.first], kNumbers * leaf.probability, 20) << count;
        sum += leaf.probability;
        i += leaf.count;
      }
      // A cluster that reaches above the horizon with a corner of its box may have nothing in it that does.
      EXPECT_LE(sum, 1 + 1e-12);
      EXPECT_NEAR(sum, chosen, 0.01) << count;
      EXPECT_NEAR(rest, 0.5 * sum, 0.05) << count;
      whole += sum > 1 - 1e-12 ? 1 : 0;
    }
  }
  EXPECT_GT(whole, 50);
}

// Clusters that a closer look finds hold every emitter once, in order, but for those below the horizon.
TEST(EmitterTreeTest, ACloserLookLeavesNothingOut) {
  std::mt19937_64 random(2);
  const EmitterTree tree = RandomTree(random, 1000);
  const Vertex vertex{{{0, -0.5}, ElementId::kNone}, {0, 1}};
  std::vector<std::uint32_t> begins;
  std::size_t leaves = 0;
  tree.OpenNear(vertex, [&](std::uint32_t cluster, double guess, const EmitterTree::Leaf& leaf) {
    EXPECT_GT(guess, 0);
    begins.push_back(tree.Begin(cluster));
    leaves += leaf.count > 0 ? 1 : 0;
    for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i)
      EXPECT_EQ(tree.FindIn(cluster, vertex, i).probability, 1);
  });
  EXPECT_TRUE(std::is_sorted(begins.begin(), begins.end()));
  EXPECT_LE(begins.size(), EmitterTree::kMostClusters);
  EXPECT_GT(begins.size(), 20u);
  EXPECT_GT(leaves, 0u);
}

// Whatever way a point was chosen, its density is told the same to a ray that hits it by chance; and no emitter that
// lights the vertex, however low over its horizon, is without a chance.
TEST(EmitterSamplerTest, SamplesHaveTheDensityOfHits) {
  for (const int lamps : {1, 10, 17, 60, 400}) {
    std::mt19937_64 random(static_cast<std::uint64_t>(lamps));
    std::uniform_real_distribution<double> place(-1, 1);
    std::uniform_real_distribution<double> unit(0, 1);
    SceneMaker maker;
    for (int i = 0; i < lamps; ++i) {
      const std::string name = "lamp " + std::to_string(i);
      const Look look{.radiance = {std::exp(3 * place(random))}, .two_sided = unit(random) < 0.2};
      const Point2 a{place(random), place(random)};
      if (unit(random) < 0.7) {
        maker.Segment(name, a, a + Vector2{0.1 * place(random), 0.1 * place(random)}, look);
      } else {
        maker.Arc(name, {a, 0.05, 6 * unit(random), unit(random) < 0.5 ? 2.0 : -5.0}, look);
      }
    }
    maker.PointProbe({0, 0}, {0, 1});
    const std::shared_ptr<const Scene> scene = maker.Build();
    std::vector<ElementId> pieces;
    for (std::size_t e = 0; e < scene->elements().size(); ++e) pieces.push_back(static_cast<ElementId>(e));
    const RayCaster caster(scene);
    const EmitterSampler sampler(scene, pieces);
    int sampled = 0;
    for (int k = 0; k < 40; ++k) {
      const Vertex vertex{{{place(random), place(random)}, ElementId::kNone}, Normalized(Vector2{place(random), 0.3})};
      EmitterSampler::View view(sampler, vertex, {});
      if (k % 2 == 1) view.LookCloser(caster);
      for (const ElementId id : pieces) {
        const Element& element = scene->element(id);
        const EmitterRange range =
            RangeOf(element, scene->curve_of(id).two_sided ? EmittingSides::kBoth : EmittingSides::kFront, vertex);
        if (range.kind != EmitterRange::Kind::kSines) continue;
        const double sine = std::clamp(range.low + 0.5 * range.width, -1.0, 1.0);
        const Vector2 direction = vertex.Direction(sine, CosineOf(sine));
        const Point2 point = PointInDirection(element, range, vertex, direction);
        const Hit hit{Length(point - vertex.at.position), id, point, FrontNormal(element, point)};
        EXPECT_GT(view.Density(hit, direction, CosineOf(sine)), 0) << lamps;
      }
      for (int i = 0; i < 50 && !view.empty(); ++i) {
        const auto sample = view.Sample(unit(random));
        if (!sample.has_value()) continue;
        const Vector2 toward = sample->point.position - vertex.at.position;
        const double distance = Length(toward);
        const Hit hit{distance, sample->point.element, sample->point.position,
                      FrontNormal(scene->element(sample->point.element), sample->point.position)};
        const double density = view.Density(hit, toward / distance, Dot(vertex.normal, toward) / distance);
        EXPECT_NEAR(density, sample->density, 1e-6 * sample->density) << lamps;
        ++sampled;
      }
    }
    EXPECT_GT(sampled, 100) << lamps;
  }
}

// What a ray to the middle of a piece meets decides how often it is sampled, and whether sampling is enough.
TEST(EmitterSamplerTest, ACloserLookGivesWhatIsHiddenAQuarter) {
  for (const bool all_hidden : {false, true}) {
    SceneMaker maker;
    for (int i = 0; i < 20; ++i) {
      const double x = i - 9.5;
      maker.Segment("lamp " + std::to_string(i), {x + 0.4, 5}, {x - 0.4, 5}, {.radiance = {1}});
    }
    maker.Segment("wall", {all_hidden ? 9.0 : 0.0, 1}, {-9, 1}, {});
    maker.PointProbe({0, 0}, {0, 1});
    const std::shared_ptr<const Scene> scene = maker.Build();
    std::vector<ElementId> pieces;
    for (std::uint32_t e = 0; e < 20; ++e) pieces.push_back(static_cast<ElementId>(e));
    const RayCaster caster(scene);
    const EmitterSampler sampler(scene, pieces);
    const Vertex vertex{{{0, 0}, ElementId::kNone}, {0, 1}};
    EmitterSampler::View view(sampler, vertex, {});
    view.LookCloser(caster);
    const auto density = [&](std::uint32_t lamp) {
      const Element& element = scene->element(static_cast<ElementId>(lamp));
      const Point2 middle = element.a + 0.5 * (element.b - element.a);
      const Vector2 direction = Normalized(middle - vertex.at.position);
      const Hit hit{Length(middle - vertex.at.position), static_cast<ElementId>(lamp), middle,
                    FrontNormal(element, middle)};
      return view.Density(hit, direction, direction.y);
    };
    for (std::uint32_t left = 0; left < 10; ++left) {
      EXPECT_NEAR(density(left) / density(19 - left), all_hidden ? 1 : 0.25, 1e-12) << left;
    }
    EXPECT_EQ(view.sufficient(), !all_hidden);
  }
}

}  // namespace
}  // namespace flatlight
