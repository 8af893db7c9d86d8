// SPDX-License-Identifier: Apache-2.0
// What is seen over mirrors and through glass, and what is said of what is left out.
#include "core/plane/reference/specular_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/plane/reference/index_growth.h"
#include "core/plane/reference/solved_world.h"
#include "core/plane/reference/specular_gather.h"
#include "core/scene/material.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

Look Glass(double ior) { return {.material = DielectricDescription{ior}}; }

struct Seen {
  double irradiance = 0;
  double lost = 0;
};

// From the scene's only point, of a sky of radiance 1, over mirrors and through glass.
Seen LookAtSky(const SceneMaker& maker, double least_share) {
  const auto scene = maker.Build();
  const RayCaster caster(scene);
  const std::vector<Chart> charts = ChartsOf(*scene);
  SpecularGather gather(caster, charts, {.least_share = least_share});
  const Receiver& receiver = scene->probes()[0].receivers[0];
  const std::vector<SpecularPiece> pieces = gather.view().From(receiver);
  Seen seen;
  seen.lost = gather.view().lost();
  for (const SpecularPiece& piece : pieces) {
    const SpecularGather::Moments moments = gather.OfPiece(receiver, piece);
    seen.irradiance += moments.value[0];
    seen.lost += moments.error;
  }
  return seen;
}

// Inside glass a ray carries less of the receiver's radiance than it may bring from outside.
TEST(SpecularViewTest, WaysThatEndInGlassMayBringMoreThanTheirShare) {
  for (const double ior : {1.5, 3.0}) {
    SceneMaker maker;
    maker.Environment({1});
    maker.Polyline("prism", {{-0.6, 0.5}, {0, 1.5}, {0.6, 0.5}}, true, Glass(ior));
    maker.PointProbe({0, 0}, {0, 1});
    const double extent = 2 * 0.6 / std::hypot(0.6, 0.5);
    for (double least_share = 1; least_share > 1e-3; least_share *= 0.6) {
      const Seen seen = LookAtSky(maker, least_share);
      EXPECT_LE(std::abs(seen.irradiance - extent), seen.lost + 1e-12) << ior << ' ' << least_share;
    }
  }
}

TEST(SpecularViewTest, IndicesOfBodiesInOneAnotherMultiply) {
  const std::vector<Point2> inner{{-0.1, -0.1}, {0.1, -0.1}, {0, 0.1}}, outer{{-1, -1}, {1, -1}, {0, 1}},
      aside{{2, -1}, {3, -1}, {2, 1}};
  SceneMaker maker;
  maker.PointProbe({0, 5}, {0, 1});
  maker.Polyline("outer", outer, true, Glass(1.5));
  EXPECT_EQ(IndexGrowth(*maker.Build()), 1.5);
  maker.Polyline("aside", aside, true, Glass(1.4));
  EXPECT_EQ(IndexGrowth(*maker.Build()), 1.5);
  maker.Polyline("inner", inner, true, Glass(0.5));
  EXPECT_EQ(IndexGrowth(*maker.Build()), 3);
  // A border that does not close may have its other side anywhere.
  maker.Segment("surface", {-9, -5}, {9, -5}, Glass(1.25));
  EXPECT_EQ(IndexGrowth(*maker.Build()), 3.75);
  // Two arcs that close are one body.
  SceneMaker lens;
  lens.PointProbe({0, 5}, {0, 1});
  lens.Arc("one", {{0, 0}, 1, 0, 3.141592653589793}, Glass(1.5));
  lens.Arc("two", {{0, 0}, 1, 3.141592653589793, 3.141592653589793}, Glass(1.5));
  EXPECT_EQ(IndexGrowth(*lens.Build()), 1.5);
}

TEST(SpecularViewTest, MirrorsThatEmitAddUp) {
  SceneMaker maker;
  maker.PointProbe({0, 5}, {0, 1});
  maker.Segment("mirror", {0, 0}, {1, 0}, {.material = MirrorDescription{SpectrumValues{0.75}}});
  EXPECT_EQ(GlowGrowth(*maker.Build())[0], 1);
  maker.Segment("bright", {0, 1}, {1, 1}, {.radiance = {1}, .material = MirrorDescription{SpectrumValues{0.75}}});
  EXPECT_EQ(GlowGrowth(*maker.Build())[0], 4);
  maker.Segment("glow", {0, 2}, {1, 2}, {.radiance = {1}, .material = DielectricDescription{1.5}});
  EXPECT_TRUE(std::isinf(GlowGrowth(*maker.Build())[0]));
}

// Where numbers are eased they have no slope at their ends, and yet few of them are the same direction.
TEST(SpecularViewTest, FewNumbersAreOneDirection) {
  const auto whole = std::make_shared<const Directions>(Directions{-1, 1, false, nullptr});
  const Directions eased{0.2, 0.7, true, whole}, twice{0.1, 0.9, true, std::make_shared<const Directions>(eased)};
  for (const Directions* directions : {whole.get(), &eased, &twice}) {
    for (const double x : {0.0, 1e-9, 1e-3, 0.5, 0.999, 1.0}) {
      const double shift = directions->Indistinct(x);
      EXPECT_GT(shift, 0);
      for (const double sign : {-1.0, 1.0})
        EXPECT_LE(std::abs(directions->At(x + sign * shift) - directions->At(x)), Directions::kSameDirection) << x;
    }
  }
}

}  // namespace
}  // namespace flatlight
