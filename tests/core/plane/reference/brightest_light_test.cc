// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/brightest_light.h"

#include <gtest/gtest.h>

#include <numbers>
#include <variant>

#include "core/scene/scene.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

// A point light of intensity I = power / (2 pi) shines I / d on what is d away, and a Lambertian curve has half of its
// reflectance of that as radiance. An arc is small beside its distance, and curves away.
TEST(BrightestLightTest, BoundsWhatAnArcReflectsOfALamp) {
  for (const double distance : {0.01, 1.0, 100.0}) {
    SceneMaker maker;
    maker.Arc("bump", {{0, 0}, 0.1, 1.3, 0.5}, {.reflectance = {0.5}});
    maker.Light(PointLightDescription{{0, 0.1 + distance}, {2 * std::numbers::pi}});
    maker.Probe("bump", 2);
    const auto scene = maker.Build();
    const PointLight& light = std::get<PointLight>(scene->lights()[0].kind);
    const Element& arc = scene->elements()[0];
    const Point2 center = arc.a - arc.radius * arc.radial_a;
    const double nearest = Length(light.position - center) - arc.radius;  // In the scene's own unit.
    const double reflected = 0.25 * light.intensity[0] / nearest;
    EXPECT_GE(BrightestLight(*scene)[0], reflected) << distance;
    EXPECT_LE(BrightestLight(*scene)[0], 3 * reflected) << distance;
  }
}

}  // namespace
}  // namespace flatlight
